#include "quorient_msgs.h"
#include "raw.hpp"
#include "security.hpp"

#include <dds/dds.h>
#include <dds/ddsc/dds_data_allocator.h>
#include <dds/ddsc/dds_loan_api.h>
#include <cstring>
#include <stdexcept>
#include <string>

namespace quorient::latency {

namespace {

dds_entity_t checked(dds_entity_t entity)
{
    if (entity < 0) throw std::runtime_error(std::string{"Cyclone DDS: "} + dds_strretcode(-entity));
    return entity;
}

const dds_topic_descriptor_t& descriptor(Type type)
{
    switch (type) {
        case Type::frame:
            return quorient_msgs_SensorFrame_desc;
        case Type::verdict:
            return quorient_msgs_FaultVerdict_desc;
        case Type::attitude:
            return quorient_msgs_AttitudeState_desc;
        case Type::voter_output:
            break;
    }
    return quorient_msgs_VoterOutput_desc;
}

dds_qos_t* make_qos(Type type)
{
    constexpr std::int32_t depth = 64;
    constexpr std::int32_t iceoryx_history = 16;
    auto* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
    if (type != Type::frame) {
        dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
        dds_qset_durability_service(qos, 0, DDS_HISTORY_KEEP_LAST, iceoryx_history, -1, -1, -1);
    }
    return qos;
}

class Writer final : public RawWriter {
public:
    Writer(dds_entity_t writer, std::size_t size) : writer_(writer), size_(size), loans_(dds_is_loan_available(writer)) {}

    void write(const void* sample) override
    {
        void* loan = nullptr;
        if (!loans_ || dds_loan_sample(writer_, &loan) != DDS_RETCODE_OK) {
            dds_write(writer_, sample);
            return;
        }
        std::memcpy(loan, sample, size_);
        dds_write(writer_, loan);
    }

    std::uint32_t matched() override
    {
        dds_publication_matched_status_t status{};
        dds_get_publication_matched_status(writer_, &status);
        return status.current_count;
    }

private:
    dds_entity_t writer_;
    std::size_t size_;
    bool loans_;
};

class Reader final : public RawReader {
public:
    explicit Reader(dds_entity_t reader) : reader_(reader) {}

    bool take(void* sample) override
    {
        dds_sample_info_t info{};
        return dds_take(reader_, &sample, &info, 1, 1) == 1 && info.valid_data;
    }

    std::uint32_t matched() override
    {
        dds_subscription_matched_status_t status{};
        dds_get_subscription_matched_status(reader_, &status);
        return status.current_count;
    }

private:
    dds_entity_t reader_;
};

class Cyclone final : public Raw {
public:
    explicit Cyclone(const RawSettings& settings)
    {
        const std::string configuration =
            "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces></General>"
            "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60</MaxAutoParticipantIndex></Discovery>"
            "<SharedMemory><Enable>" +
            std::string{settings.shared_memory ? "true" : "false"} +
            "</Enable><LogLevel>warn</LogLevel></SharedMemory></Domain></CycloneDDS>";
        domain_ = checked(dds_create_domain(settings.domain, configuration.c_str()));
        auto* qos = dds_create_qos();
        if (settings.security) bus::cyclonedds::secure(*qos, *settings.security);
        participant_ = dds_create_participant(settings.domain, qos, nullptr);
        dds_delete_qos(qos);
        checked(participant_);
        waitset_ = checked(dds_create_waitset(participant_));
    }
    ~Cyclone() override { dds_delete(domain_); }

    std::unique_ptr<RawWriter> writer(Type type, const char* topic) override
    {
        auto* qos = make_qos(type);
        const auto writer = checked(dds_create_writer(participant_, make_topic(type, topic), qos, nullptr));
        dds_delete_qos(qos);
        return std::make_unique<Writer>(writer, descriptor(type).m_size);
    }

    std::unique_ptr<RawReader> reader(Type type, const char* topic) override
    {
        auto* qos = make_qos(type);
        const auto reader = checked(dds_create_reader(participant_, make_topic(type, topic), qos, nullptr));
        dds_delete_qos(qos);
        dds_waitset_attach(waitset_, checked(dds_create_readcondition(reader, DDS_ANY_STATE)), 0);
        return std::make_unique<Reader>(reader);
    }

    void wait(std::int64_t timeout_ns) override
    {
        dds_attach_t triggered[1];
        dds_waitset_wait(waitset_, triggered, 1, timeout_ns);
    }

private:
    dds_entity_t make_topic(Type type, const char* topic)
    {
        return checked(dds_create_topic(participant_, &descriptor(type), topic, nullptr, nullptr));
    }

    dds_entity_t domain_ = 0;
    dds_entity_t participant_ = 0;
    dds_entity_t waitset_ = 0;
};

}  // namespace

std::unique_ptr<Raw> open_raw_cyclonedds(const RawSettings& settings)
{
    return std::make_unique<Cyclone>(settings);
}

}  // namespace quorient::latency
