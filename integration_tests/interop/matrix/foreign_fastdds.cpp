#include "foreign.hpp"

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <stdexcept>

#include "quorient_msgsPubSubTypes.hpp"
#include "version.hpp"

namespace foreign {

namespace {

using namespace eprosima::fastdds::dds;
namespace version = quorient::bus::fastdds;

template <class Made>
Made* checked(Made* made)
{
    if (!made) throw std::runtime_error("Fast DDS refuses an entity");
    return made;
}

template <class EndpointQos>
void apply(const Wish& wish, EndpointQos& qos)
{
    qos.reliability().kind = wish.reliable ? RELIABLE_RELIABILITY_QOS : BEST_EFFORT_RELIABILITY_QOS;
    qos.durability().kind = wish.transient_local ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
    qos.history().depth = wish.depth;
    qos.ownership().kind = wish.exclusive ? EXCLUSIVE_OWNERSHIP_QOS : SHARED_OWNERSHIP_QOS;
    qos.data_sharing().off();
}

class FastEndpoint final : public Endpoint {
public:
    FastEndpoint(DomainParticipant* participant, const std::string& topic, const Wish& wish, bool writes) : participant_(participant)
    {
        type_ = TypeSupport{wish.other_type ? static_cast<TopicDataType*>(new quorient_msgs::AttitudeStatePubSubType)
                                            : new quorient_msgs::VotedAttitudePubSubType};
        type_.register_type(participant_);
        topic_ = checked(participant_->create_topic(topic, type_.get_type_name(), TOPIC_QOS_DEFAULT));
        if (writes) make_writer(wish);
        else make_reader(wish);
    }
    ~FastEndpoint() override
    {
        if (writer_) publisher_->delete_datawriter(writer_);
        if (publisher_) participant_->delete_publisher(publisher_);
        if (reader_) subscriber_->delete_datareader(reader_);
        if (subscriber_) participant_->delete_subscriber(subscriber_);
        participant_->delete_topic(topic_);
    }

    std::uint32_t matched() override
    {
        PublicationMatchedStatus publication;
        SubscriptionMatchedStatus subscription;
        if (writer_) writer_->get_publication_matched_status(publication);
        else reader_->get_subscription_matched_status(subscription);
        return static_cast<std::uint32_t>(publication.current_count + subscription.current_count);
    }

    bool write(const Sample& sample) override
    {
        quorient_msgs::VotedAttitude message;
        message.unit(sample.unit);
        message.sequence_number(sample.sequence);
        return version::is_ok(writer_->write(&message));
    }

    bool take(Sample& sample) override
    {
        quorient_msgs::VotedAttitude message;
        SampleInfo info;
        while (version::is_ok(reader_->take_next_sample(&message, &info))) {
            if (!info.valid_data) continue;
            sample = {message.unit(), message.sequence_number()};
            return true;
        }
        return false;
    }

private:
    void make_writer(const Wish& wish)
    {
        PublisherQos group;
        if (!wish.partition.empty()) group.partition().push_back(wish.partition.c_str());
        publisher_ = checked(participant_->create_publisher(group));
        DataWriterQos qos;
        apply(wish, qos);
        qos.publish_mode().kind = SYNCHRONOUS_PUBLISH_MODE;
        version::heartbeat_period(qos) = {0, 50'000'000};
        if (wish.exclusive) {
            qos.liveliness().kind = MANUAL_BY_TOPIC_LIVELINESS_QOS;
            qos.liveliness().lease_duration = {0, 50'000'000};
            qos.liveliness().announcement_period = {0, 25'000'000};
        }
        writer_ = checked(publisher_->create_datawriter(topic_, qos));
    }

    void make_reader(const Wish& wish)
    {
        SubscriberQos group;
        if (!wish.partition.empty()) group.partition().push_back(wish.partition.c_str());
        subscriber_ = checked(participant_->create_subscriber(group));
        DataReaderQos qos;
        apply(wish, qos);
        if (wish.reader_lease_ns > 0) {
            qos.liveliness().kind = MANUAL_BY_TOPIC_LIVELINESS_QOS;
            qos.liveliness().lease_duration = {0, wish.reader_lease_ns};
        }
        reader_ = checked(subscriber_->create_datareader(topic_, qos));
    }

    DomainParticipant* participant_;
    TypeSupport type_;
    Topic* topic_ = nullptr;
    Publisher* publisher_ = nullptr;
    DataWriter* writer_ = nullptr;
    Subscriber* subscriber_ = nullptr;
    DataReader* reader_ = nullptr;
};

class FastNode final : public Node {
public:
    explicit FastNode(std::uint32_t domain)
    {
        DomainParticipantQos qos;
        auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
        udp->interfaceWhiteList = {"127.0.0.1"};
        qos.transport().use_builtin_transports = false;
        qos.transport().user_transports.push_back(udp);
        auto& builtin = qos.wire_protocol().builtin;
        builtin.discovery_config.initial_announcements.count = 50;
        builtin.discovery_config.initial_announcements.period = {0, 100'000'000};
        for (unsigned port = 9; port < 70; ++port) {
            version::wire::Locator_t locator;
            version::wire::IPLocator::setIPv4(locator, port == 9 ? "239.255.0.1" : "127.0.0.1");
            locator.port = 7400 + 250 * domain + (port == 9 ? 0 : port);
            builtin.initialPeersList.push_back(locator);
        }
        participant_ = checked(DomainParticipantFactory::get_instance()->create_participant(domain, qos));
    }
    ~FastNode() override
    {
        participant_->delete_contained_entities();
        DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }

    std::unique_ptr<Endpoint> writer(const std::string& topic, const Wish& wish) override
    {
        return std::make_unique<FastEndpoint>(participant_, topic, wish, true);
    }
    std::unique_ptr<Endpoint> reader(const std::string& topic, const Wish& wish) override
    {
        return std::make_unique<FastEndpoint>(participant_, topic, wish, false);
    }

private:
    DomainParticipant* participant_;
};

}  // namespace

std::unique_ptr<Node> plain_fastdds(std::uint32_t domain)
{
    return std::make_unique<FastNode>(domain);
}

void fastdds_by_the_wire()
{
    version::deliver_by_transports();
}

}  // namespace foreign
