#include "quorient_msgsPubSubTypes.hpp"
#include "raw.hpp"
#include "security.hpp"
#include "version.hpp"

#include <cstring>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <stdexcept>

namespace quorient::latency {

namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;
namespace version = bus::fastdds;

struct TypeEntry {
    dds::TypeSupport support;
    std::size_t size;
};

TypeEntry entry(Type type)
{
    switch (type) {
        case Type::frame:
            return {dds::TypeSupport{new quorient_msgs::SensorFramePubSubType}, sizeof(quorient_msgs::SensorFrame)};
        case Type::verdict:
            return {dds::TypeSupport{new quorient_msgs::FaultVerdictPubSubType}, sizeof(quorient_msgs::FaultVerdict)};
        case Type::attitude:
            return {dds::TypeSupport{new quorient_msgs::AttitudeStatePubSubType}, sizeof(quorient_msgs::AttitudeState)};
        case Type::voter_output:
            break;
    }
    return {dds::TypeSupport{new quorient_msgs::VoterOutputPubSubType}, sizeof(quorient_msgs::VoterOutput)};
}

template <class EndpointQos>
EndpointQos with_hot_qos(EndpointQos qos, Type type, bool shared_memory)
{
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = type == Type::frame ? dds::VOLATILE_DURABILITY_QOS : dds::TRANSIENT_LOCAL_DURABILITY_QOS;
    qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = 64;
    qos.resource_limits().max_samples = 0;
    qos.resource_limits().max_instances = 0;
    qos.resource_limits().max_samples_per_instance = 0;
    qos.endpoint().history_memory_policy = version::wire::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    if (!shared_memory) qos.data_sharing().off();
    return qos;
}

class Writer final : public RawWriter {
public:
    Writer(dds::DataWriter* writer, TypeEntry type) : writer_(writer), type_(std::move(type)), sample_(type_.support.create_data()) {}
    ~Writer() override { type_.support.delete_data(sample_); }

    void write(const void* sample) override
    {
        std::memcpy(sample_, sample, type_.size);
        writer_->write(sample_);
    }

    std::uint32_t matched() override
    {
        dds::PublicationMatchedStatus status;
        writer_->get_publication_matched_status(status);
        return static_cast<std::uint32_t>(status.current_count);
    }

private:
    dds::DataWriter* writer_;
    TypeEntry type_;
    void* sample_;
};

class Reader final : public RawReader {
public:
    Reader(dds::DataReader* reader, TypeEntry type) : reader_(reader), type_(std::move(type)), sample_(type_.support.create_data()) {}
    ~Reader() override { type_.support.delete_data(sample_); }

    bool take(void* sample) override
    {
        dds::SampleInfo info;
        if (!version::is_ok(reader_->take_next_sample(sample_, &info)) || !info.valid_data) return false;
        std::memcpy(sample, sample_, type_.size);
        return true;
    }

    std::uint32_t matched() override
    {
        dds::SubscriptionMatchedStatus status;
        reader_->get_subscription_matched_status(status);
        return static_cast<std::uint32_t>(status.current_count);
    }

private:
    dds::DataReader* reader_;
    TypeEntry type_;
    void* sample_;
};

class Fast final : public Raw {
public:
    explicit Fast(const RawSettings& settings) : shared_memory_(settings.shared_memory)
    {
        dds::DomainParticipantQos qos;
        qos.transport().use_builtin_transports = false;
        const auto udp = std::make_shared<rtps::UDPv4TransportDescriptor>();
        udp->interfaceWhiteList = {"127.0.0.1"};
        qos.transport().user_transports.push_back(udp);
        if (shared_memory_) qos.transport().user_transports.push_back(std::make_shared<rtps::SharedMemTransportDescriptor>());
        qos.wire_protocol().builtin.discovery_config.initial_announcements.count = 50;
        if (settings.security) bus::fastdds::secure(qos.properties(), *settings.security);
        participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(settings.domain, qos);
        if (!participant_) throw std::runtime_error("Fast DDS: cannot join the domain");
        publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
        subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    }

    std::unique_ptr<RawWriter> writer(Type type, const char* topic) override
    {
        auto made = entry(type);
        auto* writer =
            publisher_->create_datawriter(make_topic(made, topic), with_hot_qos(dds::DATAWRITER_QOS_DEFAULT, type, shared_memory_));
        if (!writer) throw std::runtime_error("Fast DDS: no writer");
        return std::make_unique<Writer>(writer, made);
    }

    std::unique_ptr<RawReader> reader(Type type, const char* topic) override
    {
        auto made = entry(type);
        auto* reader =
            subscriber_->create_datareader(make_topic(made, topic), with_hot_qos(dds::DATAREADER_QOS_DEFAULT, type, shared_memory_));
        if (!reader) throw std::runtime_error("Fast DDS: no reader");
        reader->get_statuscondition().set_enabled_statuses(dds::StatusMask::data_available());
        waitset_.attach_condition(reader->get_statuscondition());
        return std::make_unique<Reader>(reader, made);
    }

    void wait(std::int64_t timeout_ns) override
    {
        triggered_.clear();
        waitset_.wait(triggered_,
                      {static_cast<std::int32_t>(timeout_ns / 1'000'000'000), static_cast<std::uint32_t>(timeout_ns % 1'000'000'000)});
    }

private:
    dds::Topic* make_topic(TypeEntry& type, const char* name)
    {
        if (auto* known = dynamic_cast<dds::Topic*>(participant_->lookup_topicdescription(name))) return known;
        type.support.register_type(participant_);
        return participant_->create_topic(name, type.support.get_type_name(), dds::TOPIC_QOS_DEFAULT);
    }

    bool shared_memory_;
    dds::DomainParticipant* participant_ = nullptr;
    dds::Publisher* publisher_ = nullptr;
    dds::Subscriber* subscriber_ = nullptr;
    dds::WaitSet waitset_;
    dds::ConditionSeq triggered_;
};

}  // namespace

std::unique_ptr<Raw> open_raw_fastdds(const RawSettings& settings)
{
    return std::make_unique<Fast>(settings);
}

}  // namespace quorient::latency
