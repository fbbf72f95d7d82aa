#pragma once

/// The differences between the interfaces of Fast DDS 2.9 (Debian 12) and 3.1 (Debian 13). Everything else in this folder is written
/// against the names below, and compiles with either.

#if __has_include(<fastrtps/fastrtps_dll.h>)
#define QUORIENT_FASTDDS_2
#endif

#ifdef QUORIENT_FASTDDS_2
#include <fastdds/rtps/attributes/PropertyPolicy.h>
#include <fastdds/rtps/common/SerializedPayload.h>
#include <fastdds/rtps/common/Time_t.h>
#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/TransportInterface.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/types/TypesBase.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#else
#include <fastdds/LibrarySettings.hpp>
#include <fastdds/dds/core/ReturnCode.hpp>
#include <fastdds/dds/core/Time_t.hpp>
#include <fastdds/rtps/attributes/PropertyPolicy.hpp>
#include <fastdds/rtps/common/SerializedPayload.hpp>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.hpp>
#include <fastdds/rtps/transport/ChainingTransport.hpp>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.hpp>
#include <fastdds/rtps/transport/NetworkBuffer.hpp>
#include <fastdds/rtps/transport/SenderResource.hpp>
#include <fastdds/rtps/transport/TransportInterface.hpp>
#include <fastdds/rtps/transport/TransportReceiverInterface.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.hpp>
#include <fastdds/utils/IPLocator.hpp>
#endif
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <span>
#include <string>
#include <vector>

namespace quorient::bus::fastdds {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;
#ifdef QUORIENT_FASTDDS_2
namespace wire = eprosima::fastrtps::rtps;  ///< locators, identities, payloads, properties
#else
namespace wire = eprosima::fastdds::rtps;  ///< locators, identities, payloads, properties
#endif

/// Whether Fast DDS opened its shared memory shows in the kind of a reader's locators.
inline constexpr int shared_memory_locator = LOCATOR_KIND_SHM;

/// Another participant, as discovery describes it.
struct SeenParticipant {
    const wire::GuidPrefix_t& guid;
    std::string name;
    bool gone;
    bool unsecured;  ///< it states no security at all; release 3 does not show that, and leaves it false
    const std::vector<unsigned char>& user_data;
};

#ifdef QUORIENT_FASTDDS_2

using Duration = eprosima::fastrtps::Duration_t;
using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;

inline bool is_ok(ReturnCode code) { return code == ReturnCode::RETCODE_OK; }
inline bool is_ok(bool done) { return done; }  ///< what a write returns

inline Duration& heartbeat_period(dds::DataWriterQos& qos) { return qos.reliable_writer_qos().times.heartbeatPeriod; }
inline Duration& initial_heartbeat_delay(dds::DataWriterQos& qos) { return qos.reliable_writer_qos().times.initialHeartbeatDelay; }
inline Duration& nack_response_delay(dds::DataWriterQos& qos) { return qos.reliable_writer_qos().times.nackResponseDelay; }
inline Duration& nack_suppression_duration(dds::DataWriterQos& qos) { return qos.reliable_writer_qos().times.nackSupressionDuration; }
inline Duration& heartbeat_response_delay(dds::DataReaderQos& qos) { return qos.reliable_reader_qos().times.heartbeatResponseDelay; }

/// A datagram on its way out: the first of the two parameters that describe it; the second is its size.
using Outgoing = const wire::octet*;
inline std::span<const wire::octet> beginning(Outgoing datagram, std::uint32_t size) { return {datagram, size}; }
using SenderResource = wire::SenderResource;

/// How a type's decoder receives its payload.
using PayloadParameter = wire::SerializedPayload_t*;

inline bool is_plain(const dds::TypeSupport& type) { return type.is_plain(); }
inline std::uint32_t serialized_size(dds::TypeSupport type, void* sample) { return type.get_serialized_size_provider(sample)(); }
inline bool serialize(dds::TypeSupport type, void* sample, wire::SerializedPayload_t& payload) { return type.serialize(sample, &payload); }
inline bool deserialize(dds::TypeSupport type, wire::SerializedPayload_t& payload, void* sample) { return type.deserialize(&payload, sample); }

/// Within a process Fast DDS hands samples over without a transport, unless this is called first.
inline void deliver_by_transports()
{
    eprosima::fastrtps::LibrarySettingsAttributes settings;
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
}

/// Receives what discovery reports, from Fast DDS's own threads.
class ParticipantListener : public dds::DomainParticipantListener {
protected:
    virtual void on_participant(const SeenParticipant& participant) = 0;

private:
    void on_participant_discovery(dds::DomainParticipant*, wire::ParticipantDiscoveryInfo&& discovered) final
    {
        using Info = wire::ParticipantDiscoveryInfo;
        const bool gone = discovered.status == Info::REMOVED_PARTICIPANT || discovered.status == Info::DROPPED_PARTICIPANT;
        on_participant({discovered.info.m_guid.guidPrefix, discovered.info.m_participantName.c_str(), gone,
                        discovered.info.security_attributes_ == 0, discovered.info.m_userData.data_vec()});
    }
};

#else

using Duration = dds::Duration_t;
using ReturnCode = dds::ReturnCode_t;

inline bool is_ok(ReturnCode code) { return code == dds::RETCODE_OK; }

inline Duration& heartbeat_period(dds::DataWriterQos& qos) { return qos.reliable_writer_qos().times.heartbeat_period; }
inline Duration& initial_heartbeat_delay(dds::DataWriterQos& qos) { return qos.reliable_writer_qos().times.initial_heartbeat_delay; }
inline Duration& nack_response_delay(dds::DataWriterQos& qos) { return qos.reliable_writer_qos().times.nack_response_delay; }
inline Duration& nack_suppression_duration(dds::DataWriterQos& qos) { return qos.reliable_writer_qos().times.nack_supression_duration; }
inline Duration& heartbeat_response_delay(dds::DataReaderQos& qos) { return qos.reliable_reader_qos().times.heartbeat_response_delay; }

/// A datagram on its way out: the first of the two parameters that describe it; the second is its size.
using Outgoing = const std::vector<rtps::NetworkBuffer>&;
inline std::span<const wire::octet> beginning(Outgoing datagram, std::uint32_t)
{
    if (datagram.empty()) return {};
    return {static_cast<const wire::octet*>(datagram.front().buffer), datagram.front().size};
}
using SenderResource = rtps::SenderResource;

/// How a type's decoder receives its payload.
using PayloadParameter = wire::SerializedPayload_t&;

/// XCDR1 of a final type is the CDR that release 2 and Cyclone DDS 0.10 write.
inline constexpr auto representation = dds::XCDR_DATA_REPRESENTATION;
inline bool is_plain(const dds::TypeSupport& type) { return type.is_plain(representation); }
inline std::uint32_t serialized_size(dds::TypeSupport type, void* sample) { return type.calculate_serialized_size(sample, representation); }
inline bool serialize(dds::TypeSupport type, void* sample, wire::SerializedPayload_t& payload)
{
    return type.serialize(sample, payload, representation);
}
inline bool deserialize(dds::TypeSupport type, wire::SerializedPayload_t& payload, void* sample) { return type.deserialize(payload, sample); }

/// Within a process Fast DDS hands samples over without a transport, unless this is called first.
inline void deliver_by_transports()
{
    eprosima::fastdds::LibrarySettings settings;
    settings.intraprocess_delivery = eprosima::fastdds::INTRAPROCESS_OFF;
    dds::DomainParticipantFactory::get_instance()->set_library_settings(settings);
}

/// Receives what discovery reports, from Fast DDS's own threads.
class ParticipantListener : public dds::DomainParticipantListener {
protected:
    virtual void on_participant(const SeenParticipant& participant) = 0;

private:
    void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryStatus status,
                                  const dds::ParticipantBuiltinTopicData& discovered, bool&) final
    {
        using Status = rtps::ParticipantDiscoveryStatus;
        const bool gone = status == Status::REMOVED_PARTICIPANT || status == Status::DROPPED_PARTICIPANT;
        on_participant({discovered.guid.guidPrefix, discovered.participant_name.c_str(), gone, false,
                        discovered.user_data.data_vec()});
    }
};

#endif

}  // namespace quorient::bus::fastdds
