#include "quorient/bus/cyclonedds_bus.hpp"

#include "configuration.hpp"
#include "contract_check.hpp"
#include "quorient/bus/contract.hpp"
#include "quorient/bus/history.hpp"
#include "quorient/bus/iceoryx_guard.hpp"
#include "quorient/bus/roudi.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/time.hpp"
#include "ros2.hpp"
#include "security.hpp"
#include "sender.hpp"
#include "types.hpp"

#include <dds/dds.h>
#include <dds/ddsc/dds_data_allocator.h>
#include <dds/ddsc/dds_loan_api.h>
#include <fmt/format.h>
#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace quorient::bus {

namespace {

/// Deletes a DDS entity with its owner.
class Entity {
public:
    explicit Entity(dds_entity_t handle) : handle_(handle) {}
    ~Entity()
    {
        if (handle_ > 0) dds_delete(handle_);
    }
    Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
    Entity& operator=(Entity&& other) noexcept
    {
        std::swap(handle_, other.handle_);
        return *this;
    }
    Entity(const Entity&) = delete;
    Entity& operator=(const Entity&) = delete;

    dds_entity_t handle() const { return handle_; }

private:
    dds_entity_t handle_;
};

Entity checked(dds_entity_t handle, const std::string& what)
{
    if (handle < 0) throw Error(fmt::format("Cyclone DDS: {}: {}", what, dds_strretcode(-handle)));
    return Entity{handle};
}

struct QosDeleter {
    void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosHandle = std::unique_ptr<dds_qos_t, QosDeleter>;

constexpr dds_duration_t reliable_blocking = DDS_MSECS(100);

/// iceoryx's build limit (IOX_MAX_PUBLISHER_HISTORY). A writer that offers late joiners more silently uses UDP.
constexpr std::int32_t iceoryx_history = 16;

QosHandle to_qos(const Qos& qos, const WriterOptions* writer, Transport asked)
{
    QosHandle result{dds_create_qos()};
    auto* q = result.get();
    dds_qset_reliability(q, qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, reliable_blocking);
    dds_qset_durability(q, qos.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(q, DDS_HISTORY_KEEP_LAST, qos.depth);
    const auto kept = asked == Transport::iceoryx ? std::min(qos.depth, iceoryx_history) : qos.depth;
    if (qos.transient_local) dds_qset_durability_service(q, 0, DDS_HISTORY_KEEP_LAST, kept, -1, -1, -1);
    if (qos.latched)
        dds_qset_history(q, DDS_HISTORY_KEEP_ALL, 0);  // KEEP_ALL keeps shared memory off; the depth for late joiners is set above
    if (qos.exclusive) {
        dds_qset_ownership(q, DDS_OWNERSHIP_EXCLUSIVE);
        if (writer) {
            dds_qset_ownership_strength(q, writer->strength);
            dds_qset_liveliness(q, DDS_LIVELINESS_MANUAL_BY_TOPIC, nanoseconds(offered_lease_s(writer->lease_s)));
        }
    }
    return result;
}

std::string_view policy_name(std::uint32_t id)
{
    switch (id) {
        case DDS_DURABILITY_QOS_POLICY_ID:
            return "DURABILITY";
        case DDS_DEADLINE_QOS_POLICY_ID:
            return "DEADLINE";
        case DDS_OWNERSHIP_QOS_POLICY_ID:
            return "OWNERSHIP";
        case DDS_LIVELINESS_QOS_POLICY_ID:
            return "LIVELINESS";
        case DDS_RELIABILITY_QOS_POLICY_ID:
            return "RELIABILITY";
        case DDS_PARTITION_QOS_POLICY_ID:
            return "PARTITION";
        case DDS_DATA_REPRESENTATION_QOS_POLICY_ID:
            return "DATA_REPRESENTATION";
        default:
            return "another policy";
    }
}

Transport transport_of(dds_entity_t endpoint)
{
    return dds_is_shared_memory_available(endpoint) ? Transport::iceoryx : Transport::udp;
}

/// Reports a memory pool that is too small at the start, not by the first lost sample.
void check_room(dds_entity_t writer, const TopicSpec& topic)
{
    void* sample = nullptr;
    if (dds_loan_sample(writer, &sample) != DDS_RETCODE_OK)
        throw Error(fmt::format(
            "iceoryx's daemon has no free chunk for {}: its configuration needs a pool with size = {} ([[segment.mempool]]) and "
            "enough of them for all readers' histories, as quorient launch writes it to roudi.toml in the run directory",
            topic.name, chunk_size(topic.size)));
    dds_return_loan(writer, &sample, 1);
}

/// The transport that the settings ask for on this topic. Latched topics never use iceoryx by design, exclusive ones because of their
/// liveliness.
Transport asked_for(const TopicSpec& topic, Transport asked)
{
    return topic.qos.latched || topic.qos.exclusive || cyclonedds::is_ros2(topic.type) ? Transport::udp : asked;
}

class CycloneWriter final : public Writer {
public:
    CycloneWriter(Entity writer, const TopicSpec& topic, Transport asked)
        : writer_(std::move(writer)), type_(topic.type), size_(topic.size), asked_(asked), loans_(dds_is_loan_available(writer_.handle()))
    {
    }

    bool write(const void* message) override
    {
        const bool taken = cyclonedds::is_ros2(type_) ? cyclonedds::write_ros2(type_, writer_.handle(), message) : write_plain(message);
        if (!taken) ++refused_;
        return taken;
    }

    void assert_liveliness() override { dds_assert_liveliness(writer_.handle()); }

    EndpointStatus status() override
    {
        dds_publication_matched_status_t matched{};
        dds_offered_incompatible_qos_status_t incompatible{};
        dds_get_publication_matched_status(writer_.handle(), &matched);
        dds_get_offered_incompatible_qos_status(writer_.handle(), &incompatible);
        return {matched.current_count,
                incompatible.total_count,
                policy_name(incompatible.last_policy_id),
                transport_of(writer_.handle()),
                asked_,
                refused_};
    }

private:
    /// Without readers Cyclone DDS unregisters the instance after every sample and cleans up in a background thread. Registering it once
    /// avoids that.
    bool keep_instance_of(const void* message)
    {
        dds_instance_handle_t kept = 0;
        return dds_register_instance(writer_.handle(), &kept, message) == DDS_RETCODE_OK;
    }

    bool write_plain(const void* message)
    {
        if (!registered_) registered_ = keep_instance_of(message);
        if (!loans_) return dds_write(writer_.handle(), message) == DDS_RETCODE_OK;
        void* sample = nullptr;
        if (dds_loan_sample(writer_.handle(), &sample) != DDS_RETCODE_OK) return false;
        std::memcpy(sample, message, size_);
        return dds_write(writer_.handle(), sample) == DDS_RETCODE_OK;
    }

    Entity writer_;
    TypeId type_;
    std::size_t size_;
    Transport asked_;
    bool loans_;
    bool registered_ = false;
    std::uint64_t refused_ = 0;
};

class CycloneReader final : public Reader {
public:
    /// @param skipped  handles of the writers whose samples are skipped; must outlive the reader
    CycloneReader(Entity reader, TypeId type, Transport asked, bool secured, const std::vector<dds_instance_handle_t>* skipped, Refusals& refusals)
        : reader_(std::move(reader)), type_(type), asked_(asked), secured_(secured), skipped_(skipped), contracts_(reader_.handle(), refusals)
    {
    }

    bool take(void* message) override
    {
        if (cyclonedds::is_ros2(type_)) return cyclonedds::take_ros2(type_, reader_.handle(), message);
        dds_sample_info_t info{};
        void* samples[1] = {message};
        while (dds_take(reader_.handle(), samples, &info, 1, 1) == 1) {
            if (!info.valid_data || is_skipped(info.publication_handle)) continue;
            writer_ = info.publication_handle;
            if (!contracts_.accepts(writer_)) continue;
            return true;
        }
        return false;
    }

    EndpointStatus status() override
    {
        dds_subscription_matched_status_t matched{};
        dds_requested_incompatible_qos_status_t incompatible{};
        dds_get_subscription_matched_status(reader_.handle(), &matched);
        dds_get_requested_incompatible_qos_status(reader_.handle(), &incompatible);
        return {matched.current_count, incompatible.total_count, policy_name(incompatible.last_policy_id), transport_of(reader_.handle()),
                asked_};
    }

    Sender sender() override { return cyclonedds::sender_of(reader_.handle(), writer_, secured_); }

private:
    bool is_skipped(dds_instance_handle_t writer) const { return skipped_ && std::ranges::find(*skipped_, writer) != skipped_->end(); }

    Entity reader_;
    TypeId type_;
    Transport asked_;
    bool secured_;
    const std::vector<dds_instance_handle_t>* skipped_;
    cyclonedds::ContractCheck contracts_;
    dds_instance_handle_t writer_ = 0;  ///< the writer of the sample taken last
};

class CycloneBus final : public Bus {
public:
    CycloneBus(Entity domain, Entity participant, const Settings& settings, bool shared, OwnSamples own)
        : settings_(settings),
          own_(own),
          roudi_life_(shared ? roudi_life() : 0),
          domain_(std::move(domain)),
          participant_(std::move(participant)),
          waitset_(checked(dds_create_waitset(participant_.handle()), "wait set"))
    {
    }

    void wait(std::int64_t timeout_ns) override
    {
        dds_attach_t triggered[1];
        dds_waitset_wait(waitset_.handle(), triggered, 1, timeout_ns);
    }

    Vendor vendor() const override { return Vendor::cyclonedds; }

    std::vector<Refusal> refusals() override
    {
        auto all = refusals_.take();
        if (!settings_.security) return all;
        for (auto& refusal : cyclonedds::library_refusals().take()) all.push_back(std::move(refusal));
        return all;
    }

    bool shared_memory_lost() const override { return roudi_life_ != 0 && roudi_life() != roudi_life_; }

private:
    std::unique_ptr<Writer> make_writer(const TopicSpec& topic, const WriterOptions& options) override
    {
        const auto asked = asked_for(topic, settings_.transport);
        const auto qos = to_qos(topic.qos, &options, asked);
        if (topic.qos.exclusive) dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kept_samples(topic.qos, options, settings_));
        auto writer = checked(dds_create_writer(participant_.handle(), topic_of(topic), qos.get(), nullptr), topic.name);
        if (dds_is_loan_available(writer.handle())) check_room(writer.handle(), topic);
        if (skips_own(own_, topic)) skipped_.push_back(instance_of(writer));
        return std::make_unique<CycloneWriter>(std::move(writer), topic, asked);
    }

    std::unique_ptr<Reader> make_reader(const TopicSpec& topic, const ReaderOptions& options) override
    {
        const auto asked = asked_for(topic, settings_.transport);
        const auto qos = to_qos(topic.qos, nullptr, asked);
        const bool skips = skips_own(own_, topic);
        // By iceoryx own samples still arrive, so the reader looks at each sample's writer, too.
        if (skips) dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
        auto reader = checked(dds_create_reader(participant_.handle(), topic_of(topic), qos.get(), nullptr), topic.name);
        if (options.wake == Wake::at_once) wait_for(reader, topic);
        return std::make_unique<CycloneReader>(std::move(reader), topic.type, asked, settings_.security.has_value(),
                                               skips ? &skipped_ : nullptr, refusals_);
    }

    void wait_for(const Entity& reader, const TopicSpec& topic)
    {
        const auto condition = dds_create_readcondition(reader.handle(), DDS_ANY_STATE);
        if (condition < 0 || dds_waitset_attach(waitset_.handle(), condition, 0) < 0)
            throw Error(fmt::format("Cyclone DDS: {}: cannot wait for data", topic.name));
    }

    static dds_instance_handle_t instance_of(const Entity& entity)
    {
        dds_instance_handle_t handle = 0;
        if (dds_get_instance_handle(entity.handle(), &handle) != DDS_RETCODE_OK) throw Error("Cyclone DDS: a writer has no handle");
        return handle;
    }

    dds_entity_t topic_of(const TopicSpec& spec)
    {
        const auto known = topics_.find(spec.name);
        if (known != topics_.end()) return known->second;
        const auto topic = dds_create_topic(participant_.handle(), &cyclonedds::descriptor_of(spec.type), spec.name, nullptr, nullptr);
        if (topic < 0) throw Error(fmt::format("Cyclone DDS: topic {}: {}", spec.name, dds_strretcode(-topic)));
        return topics_.emplace(spec.name, topic).first->second;
    }

    Settings settings_;
    OwnSamples own_;
    std::vector<dds_instance_handle_t> skipped_;  ///< own writers whose samples come another way
    std::uint64_t roudi_life_;
    Entity domain_;  // outlives the participant, which takes everything it made with it
    Entity participant_;
    Entity waitset_;
    std::map<std::string, dds_entity_t> topics_;
    Refusals refusals_;  ///< by this bus's readers
};

}  // namespace

tl::expected<std::unique_ptr<Bus>, std::string> open_cyclonedds(const Settings& settings, OwnSamples own)
{
    bool shared = settings.transport == Transport::iceoryx && settings.shared_memory != SharedMemory::off;
    if (shared) {
        auto refusal = roudi_silence();
        if (refusal.empty()) refusal = iceoryx_refusal();
        if (!refusal.empty() && settings.shared_memory == SharedMemory::required) return tl::make_unexpected(refusal);
        shared = refusal.empty();
    }
    if (shared) survive_full_pools();
    // A second bus of this process in the same domain shares the first one's domain and its configuration.
    const auto domain = dds_create_domain(settings.domain, cyclonedds::configuration(settings, shared).c_str());
    if (domain < 0 && domain != DDS_RETCODE_PRECONDITION_NOT_MET)
        return tl::make_unexpected(fmt::format("Cyclone DDS: domain {}: {}", settings.domain, dds_strretcode(-domain)));
    Entity owned_domain{domain};

    const QosHandle qos{dds_create_qos()};
    dds_qset_entity_name(qos.get(), settings.participant.c_str());
    const auto announcement = contract_announcement();
    dds_qset_userdata(qos.get(), announcement.data(), announcement.size());
    if (settings.security) {
        cyclonedds::library_refusals();  // reads the log from now on
        cyclonedds::secure(*qos, *settings.security);
    }
    const auto participant = dds_create_participant(settings.domain, qos.get(), nullptr);
    if (participant < 0) return tl::make_unexpected(fmt::format("Cyclone DDS: participant: {}", dds_strretcode(-participant)));
    try {
        return std::make_unique<CycloneBus>(std::move(owned_domain), Entity{participant}, settings, shared, own);
    } catch (const Error& error) {
        return tl::make_unexpected(std::string{error.what()});
    }
}

}  // namespace quorient::bus
