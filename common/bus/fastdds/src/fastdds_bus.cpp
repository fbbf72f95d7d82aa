#include "quorient/bus/fastdds_bus.hpp"

#include "quorient/bus/history.hpp"
#include "quorient/messages/meaning.hpp"

#include "participant.hpp"
#include "ros2.hpp"
#include "security.hpp"
#include "types.hpp"
#include "version.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstring>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <map>

namespace quorient::bus {

namespace dds = fastdds::dds;

namespace {

using fastdds::seconds;
using fastdds::shares_memory;

std::string_view policy_name(dds::QosPolicyId_t id)
{
    switch (id) {
        case dds::DURABILITY_QOS_POLICY_ID:
            return "DURABILITY";
        case dds::DEADLINE_QOS_POLICY_ID:
            return "DEADLINE";
        case dds::OWNERSHIP_QOS_POLICY_ID:
            return "OWNERSHIP";
        case dds::LIVELINESS_QOS_POLICY_ID:
            return "LIVELINESS";
        case dds::RELIABILITY_QOS_POLICY_ID:
            return "RELIABILITY";
        case dds::PARTITION_QOS_POLICY_ID:
            return "PARTITION";
        case dds::DATAREPRESENTATION_QOS_POLICY_ID:
            return "DATA_REPRESENTATION";
        default:
            return "another policy";
    }
}

/// What both ends of a topic share. Resource limits of 0 are "no limit": the default of ten instances is fewer than a system has services.
template <class EndpointQos>
void apply(const Qos& qos, const Settings& settings, EndpointQos& endpoint)
{
    endpoint.reliability().kind = qos.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
    endpoint.durability().kind = qos.transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
    endpoint.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    endpoint.history().depth = qos.depth;
    endpoint.resource_limits().max_samples = 0;
    endpoint.resource_limits().max_instances = 0;
    endpoint.resource_limits().max_samples_per_instance = 0;
    endpoint.endpoint().history_memory_policy = fastdds::wire::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    endpoint.ownership().kind = qos.exclusive ? dds::EXCLUSIVE_OWNERSHIP_QOS : dds::SHARED_OWNERSHIP_QOS;
    if (!shares_memory(settings)) endpoint.data_sharing().off();
}

/// Whether Fast DDS really opened its shared memory: if it could not, it silently continues by UDP. Only a reader shows it, because a
/// writer's list of sending locators omits shared memory.
Transport transport_of(const dds::DataReader& reader)
{
    fastdds::rtps::LocatorList locators;
    reader.get_listening_locators(locators);
    for (auto locator = locators.begin(); locator != locators.end(); ++locator) {
        if (locator->kind == fastdds::shared_memory_locator) return Transport::shared_memory;
    }
    return Transport::udp;
}

/// Endpoints of this bus on one topic that do not count as each other's peers: the readers skip what the writers publish.
struct OwnEndpoints {
    std::int32_t writers = 0;
    std::int32_t readers = 0;
};

std::uint32_t peers_of(std::int32_t matched, std::int32_t own)
{
    return static_cast<std::uint32_t>(std::max(matched - own, 0));
}

/// The same for all endpoints of a participant.
struct Transports {
    Transport in_use;
    Transport asked;
};

class FastWriter final : public Writer {
public:
    /// @param own  counts this writer, where readers of the same bus skip its samples
    FastWriter(dds::Publisher* publisher, dds::DataWriter* writer, dds::TypeSupport type, const TopicSpec& topic, Transports transports,
               std::shared_ptr<OwnEndpoints> own)
        : publisher_(publisher),
          writer_(writer),
          type_(std::move(type)),
          sample_(type_.create_data()),
          topic_(topic),
          transports_(transports),
          own_(std::move(own))
    {
        if (own_) ++own_->writers;
    }
    ~FastWriter() override
    {
        if (own_) --own_->writers;
        publisher_->delete_datawriter(writer_);
        type_.delete_data(sample_);
    }

    bool write(const void* message) override
    {
        if (fastdds::is_ros2(topic_.type)) fastdds::ros2_to_vendor(topic_.type, message, sample_);
        else std::memcpy(sample_, message, topic_.size);
        const bool taken = fastdds::is_ok(writer_->write(sample_));
        if (!taken) ++refused_;
        return taken;
    }

    void assert_liveliness() override { writer_->assert_liveliness(); }

    EndpointStatus status() override
    {
        dds::PublicationMatchedStatus matched;
        dds::OfferedIncompatibleQosStatus incompatible;
        writer_->get_publication_matched_status(matched);
        writer_->get_offered_incompatible_qos_status(incompatible);
        return {peers_of(matched.current_count, own_ ? own_->readers : 0),
                incompatible.total_count,
                policy_name(incompatible.last_policy_id),
                transports_.in_use,
                transports_.asked,
                refused_};
    }

private:
    dds::Publisher* publisher_;
    dds::DataWriter* writer_;
    dds::TypeSupport type_;
    void* sample_;
    TopicSpec topic_;
    Transports transports_;
    std::shared_ptr<OwnEndpoints> own_;
    std::uint64_t refused_ = 0;
};

GuidPrefix prefix_of(const dds::InstanceHandle_t& endpoint)
{
    GuidPrefix guid{};
    for (std::size_t i = 0; i < guid.size(); ++i) guid[i] = endpoint.value[i];
    return guid;
}

class FastReader final : public Reader {
public:
    /// @param waitset  wakes for its samples; none: they wake nobody
    /// @param own  counts this reader, where it skips the samples of its own bus
    FastReader(dds::Subscriber* subscriber, dds::DataReader* reader, dds::WaitSet* waitset, dds::TypeSupport type, const TopicSpec& topic,
               Transports transports, const fastdds::Peers& peers, std::shared_ptr<OwnEndpoints> own)
        : subscriber_(subscriber),
          reader_(reader),
          waitset_(waitset),
          type_(std::move(type)),
          sample_(type_.create_data()),
          topic_(topic),
          transports_(transports),
          peers_(peers),
          own_(std::move(own)),
          participant_(prefix_of(reader->get_instance_handle()))
    {
        if (own_) ++own_->readers;
        reader_->get_statuscondition().set_enabled_statuses(dds::StatusMask::data_available());
        if (waitset_) waitset_->attach_condition(reader_->get_statuscondition());
    }
    ~FastReader() override
    {
        if (own_) --own_->readers;
        if (waitset_) waitset_->detach_condition(reader_->get_statuscondition());
        subscriber_->delete_datareader(reader_);
        type_.delete_data(sample_);
    }

    bool take(void* message) override
    {
        dds::SampleInfo info;
        while (fastdds::is_ok(reader_->take_next_sample(sample_, &info))) {
            if (!info.valid_data || is_skipped(info)) continue;
            writer_ = info.publication_handle;
            if (peers_.refuses(prefix_of(writer_))) continue;
            if (fastdds::is_ros2(topic_.type)) fastdds::ros2_from_vendor(topic_.type, sample_, message);
            else std::memcpy(message, sample_, topic_.size);
            return true;
        }
        return false;
    }

    EndpointStatus status() override
    {
        dds::SubscriptionMatchedStatus matched;
        dds::RequestedIncompatibleQosStatus incompatible;
        reader_->get_subscription_matched_status(matched);
        reader_->get_requested_incompatible_qos_status(incompatible);
        return {peers_of(matched.current_count, own_ ? own_->writers : 0), incompatible.total_count,
                policy_name(incompatible.last_policy_id), transports_.in_use, transports_.asked};
    }

    Sender sender() override { return peers_.sender(prefix_of(writer_)); }

private:
    /// Fast DDS 2.9 cannot ignore the writers of its own participant.
    bool is_skipped(const dds::SampleInfo& info) const
    {
        return own_ && prefix_of(info.publication_handle) == participant_;
    }

    dds::Subscriber* subscriber_;
    dds::DataReader* reader_;
    dds::WaitSet* waitset_;
    dds::TypeSupport type_;
    void* sample_;
    TopicSpec topic_;
    Transports transports_;
    const fastdds::Peers& peers_;
    std::shared_ptr<OwnEndpoints> own_;
    GuidPrefix participant_;
    dds::InstanceHandle_t writer_;  ///< the writer of the sample taken last
};

class FastBus final : public Bus {
public:
    FastBus(const Settings& settings, std::unique_ptr<fastdds::Peers> peers, dds::DomainParticipant* participant, OwnSamples own)
        : settings_(settings),
          own_samples_(own),
          peers_(std::move(peers)),
          participant_(participant),
          publisher_(participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT)),
          subscriber_(participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT)),
          transports_{Transport::udp, settings.transport}
    {
        if (shares_memory(settings)) transports_.in_use = transport_in_use();
    }
    ~FastBus() override
    {
        participant_->delete_contained_entities();
        dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }

    void wait(std::int64_t timeout_ns) override
    {
        triggered_.clear();
        waitset_.wait(triggered_, seconds(static_cast<double>(timeout_ns) * 1e-9));
    }

    Vendor vendor() const override { return Vendor::fastdds; }

    std::vector<Refusal> refusals() override
    {
        auto all = peers_->refusals();
        if (!settings_.security) return all;
        for (const auto& entry : fastdds::library_refusals().take()) all.push_back({entry.reason, peers_->in_words(entry.text)});
        return all;
    }

    Transport transport() const { return transports_.in_use; }

private:
    /// Found by a temporary reader.
    Transport transport_in_use()
    {
        auto [type, entity] = topic_of(topics::status.spec);
        auto* reader = subscriber_->create_datareader(entity, dds::DATAREADER_QOS_DEFAULT);
        if (!reader) return Transport::udp;
        const auto found = transport_of(*reader);
        subscriber_->delete_datareader(reader);
        return found;
    }

    std::unique_ptr<Writer> make_writer(const TopicSpec& topic, const WriterOptions& options) override
    {
        dds::DataWriterQos qos = publisher_->get_default_datawriter_qos();
        apply(topic.qos, settings_, qos);
        qos.history().depth = kept_samples(topic.qos, options, settings_);
        qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
        // The default heartbeat of 3 s leaves a Cyclone reader that matched late without its history.
        fastdds::heartbeat_period(qos) = seconds(heartbeat_s(settings_));
        fastdds::nack_response_delay(qos) = seconds(0);
        fastdds::nack_suppression_duration(qos) = seconds(repair_pause_s(settings_));
        fastdds::initial_heartbeat_delay(qos) = seconds(0);
        if (topic.qos.exclusive) {
            qos.ownership_strength().value = static_cast<std::uint32_t>(options.strength);
            qos.liveliness().kind = dds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
            qos.liveliness().lease_duration = seconds(offered_lease_s(options.lease_s));
            qos.liveliness().announcement_period = seconds(options.lease_s / 2);
        }
        auto [type, entity] = topic_of(topic);
        auto* writer = publisher_->create_datawriter(entity, qos);
        if (!writer) throw Error(fmt::format("Fast DDS: cannot write {}", topic.name));
        return std::make_unique<FastWriter>(publisher_, writer, type, topic, transports_, own_endpoints_of(topic));
    }

    std::unique_ptr<Reader> make_reader(const TopicSpec& topic, const ReaderOptions& options) override
    {
        dds::DataReaderQos qos = subscriber_->get_default_datareader_qos();
        apply(topic.qos, settings_, qos);
        fastdds::heartbeat_response_delay(qos) = seconds(0);
        if (topic.qos.exclusive) {
            // Fast DDS monitors a writer by the reader's own lease alone. With the infinite default a dead owner stays the owner.
            qos.liveliness().kind = dds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
            qos.liveliness().lease_duration = seconds(settings_.voted_lease_s);
        }
        auto [type, entity] = topic_of(topic);
        auto* reader = subscriber_->create_datareader(entity, qos);
        if (!reader) throw Error(fmt::format("Fast DDS: cannot read {}", topic.name));
        auto* waitset = options.wake == Wake::at_once ? &waitset_ : nullptr;
        return std::make_unique<FastReader>(subscriber_, reader, waitset, type, topic, transports_, *peers_, own_endpoints_of(topic));
    }

    /// @returns nothing where readers of this topic receive what their own bus writes
    std::shared_ptr<OwnEndpoints> own_endpoints_of(const TopicSpec& topic)
    {
        if (!skips_own(own_samples_, topic)) return nullptr;
        auto& own = own_endpoints_[topic.name];
        if (!own) own = std::make_shared<OwnEndpoints>();
        return own;
    }

    std::pair<dds::TypeSupport, dds::Topic*> topic_of(const TopicSpec& spec)
    {
        const auto type = fastdds::type_support_of(spec.type);
        auto& entity = topics_[spec.name];
        if (!entity) {
            type.register_type(participant_);
            entity = participant_->create_topic(spec.name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
        }
        if (!entity) throw Error(fmt::format("Fast DDS: cannot make topic {}", spec.name));
        return {type, entity};
    }

    Settings settings_;
    OwnSamples own_samples_;
    std::unique_ptr<fastdds::Peers> peers_;
    dds::DomainParticipant* participant_;
    dds::Publisher* publisher_;
    dds::Subscriber* subscriber_;
    dds::WaitSet waitset_;
    dds::ConditionSeq triggered_;
    std::map<std::string, dds::Topic*> topics_;
    std::map<std::string, std::shared_ptr<OwnEndpoints>> own_endpoints_;
    Transports transports_;
};

}  // namespace

tl::expected<std::unique_ptr<Bus>, std::string> open_fastdds(const Settings& asked, OwnSamples own)
{
    const auto checked = fastdds::with_room_in_shared_memory(asked);
    if (!checked) return tl::make_unexpected(checked.error());
    const auto& settings = *checked;
    auto peers = std::make_unique<fastdds::Peers>(settings.security.has_value());
    auto* participant = fastdds::join(settings, *peers);
    if (!participant) return tl::make_unexpected(fmt::format("Fast DDS: cannot join domain {}", settings.domain));
    auto bus = std::make_unique<FastBus>(settings, std::move(peers), participant, own);
    if (shares_memory(settings) && settings.shared_memory == SharedMemory::required && bus->transport() == Transport::udp)
        return tl::make_unexpected(std::string{
            "Fast DDS cannot open its shared memory in /dev/shm (read-only, or of another user?): mend that, or use transport udp, "
            "or shared_memory: preferred"});
    return bus;
}

}  // namespace quorient::bus
