#include "foreign.hpp"

#include <dds/dds.h>
#include <stdexcept>

#include "quorient_msgs.h"

namespace foreign {

namespace {

dds_entity_t made(dds_entity_t entity, const char* what)
{
    if (entity < 0) throw std::runtime_error(std::string{"Cyclone DDS: "} + what + ": " + dds_strretcode(-entity));
    return entity;
}

class CycloneEndpoint final : public Endpoint {
public:
    CycloneEndpoint(dds_entity_t group, dds_entity_t topic, dds_entity_t endpoint, bool writes)
        : group_(group), topic_(topic), endpoint_(endpoint), writes_(writes)
    {
    }
    ~CycloneEndpoint() override
    {
        dds_delete(group_);
        dds_delete(topic_);
    }

    std::uint32_t matched() override
    {
        dds_publication_matched_status_t publication{};
        dds_subscription_matched_status_t subscription{};
        if (writes_) dds_get_publication_matched_status(endpoint_, &publication);
        else dds_get_subscription_matched_status(endpoint_, &subscription);
        return publication.current_count + subscription.current_count;
    }

    bool write(const Sample& sample) override
    {
        quorient_msgs_VotedAttitude message{};
        message.unit = sample.unit;
        message.sequence_number = sample.sequence;
        return dds_write(endpoint_, &message) == DDS_RETCODE_OK;
    }

    bool take(Sample& sample) override
    {
        quorient_msgs_VotedAttitude message{};
        void* samples[1] = {&message};
        dds_sample_info_t info{};
        while (dds_take(endpoint_, samples, &info, 1, 1) == 1) {
            if (!info.valid_data) continue;
            sample = {message.unit, message.sequence_number};
            return true;
        }
        return false;
    }

private:
    dds_entity_t group_;
    dds_entity_t topic_;
    dds_entity_t endpoint_;
    bool writes_;
};

class CycloneNode final : public Node {
public:
    /// A Cyclone domain of its own in this process, which on the wire is the one asked for: else our own Cyclone participants would hand
    /// samples over in memory.
    explicit CycloneNode(std::uint32_t domain) : domain_(made(dds_create_domain(domain + 1000, configuration(domain).c_str()), "domain"))
    {
        participant_ = made(dds_create_participant(domain + 1000, nullptr, nullptr), "participant");
    }
    ~CycloneNode() override { dds_delete(domain_); }

    std::unique_ptr<Endpoint> writer(const std::string& topic, const Wish& wish) override { return make(topic, wish, true); }
    std::unique_ptr<Endpoint> reader(const std::string& topic, const Wish& wish) override { return make(topic, wish, false); }

private:
    static std::string configuration(std::uint32_t domain)
    {
        return "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces></General>"
               "<Discovery><ExternalDomainId>" +
               std::to_string(domain) +
               "</ExternalDomainId><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60</MaxAutoParticipantIndex>"
               "</Discovery><Internal><GenerateKeyhash>true</GenerateKeyhash></Internal></Domain></CycloneDDS>";
    }

    std::unique_ptr<Endpoint> make(const std::string& topic_name, const Wish& wish, bool writes)
    {
        dds_qos_t* qos = dds_create_qos();
        const char* partitions[1] = {wish.partition.c_str()};
        if (!wish.partition.empty()) dds_qset_partition(qos, 1, partitions);
        const auto group =
            made(writes ? dds_create_publisher(participant_, qos, nullptr) : dds_create_subscriber(participant_, qos, nullptr), "group");
        dds_reset_qos(qos);
        dds_qset_reliability(qos, wish.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_MSECS(100));
        dds_qset_durability(qos, wish.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
        dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, wish.depth);
        dds_qset_durability_service(qos, 0, DDS_HISTORY_KEEP_LAST, wish.depth, -1, -1, -1);
        if (wish.exclusive) dds_qset_ownership(qos, DDS_OWNERSHIP_EXCLUSIVE);
        if (wish.exclusive && writes) dds_qset_liveliness(qos, DDS_LIVELINESS_MANUAL_BY_TOPIC, DDS_MSECS(50));
        if (wish.reader_lease_ns > 0 && !writes) dds_qset_liveliness(qos, DDS_LIVELINESS_MANUAL_BY_TOPIC, wish.reader_lease_ns);
        const auto& type = wish.other_type ? quorient_msgs_AttitudeState_desc : quorient_msgs_VotedAttitude_desc;
        const auto topic = made(dds_create_topic(participant_, &type, topic_name.c_str(), nullptr, nullptr), "topic");
        const auto endpoint =
            made(writes ? dds_create_writer(group, topic, qos, nullptr) : dds_create_reader(group, topic, qos, nullptr), "endpoint");
        dds_delete_qos(qos);
        return std::make_unique<CycloneEndpoint>(group, topic, endpoint, writes);
    }

    dds_entity_t domain_;
    dds_entity_t participant_ = 0;
};

}  // namespace

std::unique_ptr<Node> plain_cyclonedds(std::uint32_t domain)
{
    return std::make_unique<CycloneNode>(domain);
}

}  // namespace foreign
