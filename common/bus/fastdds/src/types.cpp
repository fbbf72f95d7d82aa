#include "types.hpp"

#include "quorient_msgsPubSubTypes.hpp"
#include "ros2.hpp"
#include "tolerant_type.hpp"

#include <stdexcept>

namespace quorient::bus::fastdds {

namespace {

template <class PubSubType, class Plain>
eprosima::fastdds::dds::TypeSupport make()
{
    static_assert(std::is_standard_layout_v<typename PubSubType::type> && sizeof(typename PubSubType::type) == sizeof(Plain));
    return eprosima::fastdds::dds::TypeSupport{new TolerantType<PubSubType>};
}

}  // namespace

eprosima::fastdds::dds::TypeSupport type_support_of(TypeId type)
{
    switch (type) {
        case TypeId::cluster_description:
            return make<quorient_msgs::ClusterDescriptionPubSubType, ClusterDescription>();
        case TypeId::sensor_frame:
            return make<quorient_msgs::SensorFramePubSubType, SensorFrame>();
        case TypeId::truth_state:
            return make<quorient_msgs::TruthStatePubSubType, TruthState>();
        case TypeId::fault_verdict:
            return make<quorient_msgs::FaultVerdictPubSubType, FaultVerdict>();
        case TypeId::fault_diagnosis:
            return make<quorient_msgs::FaultDiagnosisPubSubType, FaultDiagnosis>();
        case TypeId::attitude_state:
            return make<quorient_msgs::AttitudeStatePubSubType, AttitudeState>();
        case TypeId::voter_output:
            return make<quorient_msgs::VoterOutputPubSubType, VotedAttitude>();
        case TypeId::voted_attitude:
            return make<quorient_msgs::VotedAttitudePubSubType, VotedAttitude>();
        case TypeId::health_event:
            return make<quorient_msgs::HealthEventPubSubType, HealthEvent>();
        case TypeId::service_status:
            return make<quorient_msgs::ServiceStatusPubSubType, ServiceStatus>();
        case TypeId::fault_command:
            return make<quorient_msgs::FaultCommandPubSubType, FaultCommand>();
        case TypeId::ros2_imu:
        case TypeId::ros2_diagnostics:
            return ros2_type_support_of(type);
    }
    throw std::logic_error("no such type of the IDL");
}

}  // namespace quorient::bus::fastdds
