#include "types.hpp"

#include "quorient_msgs.h"
#include "ros2.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

namespace quorient::bus::cyclonedds {

namespace {

// Each row: a member of the IDL is at the same place and of the same size in the generated struct and in the plain one.
// A macro, since offsetof takes names.
#define QUORIENT_SAME(Generated, Plain, generated_member, plain_member)                    \
    static_assert(offsetof(Generated, generated_member) == offsetof(Plain, plain_member)); \
    static_assert(sizeof(Generated::generated_member) == sizeof(Plain::plain_member))

static_assert(std::is_trivially_copyable_v<ClusterDescription> && sizeof(quorient_msgs_ClusterDescription) == sizeof(ClusterDescription));
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, epoch, epoch);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, interval_s, interval_s);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, axis, axis);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, position_m, position_m);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, sigma, sigma);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, quantum, quantum);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, range, range);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, bias, bias);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, initial_attitude, initial_attitude);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, unit, unit);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, revision, revision);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, instrument, instrument);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, instrument_name, instrument_name);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, name, name);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, kind, kind);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, axis_count, axis_count);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, instrument_count, instrument_count);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, initial_attitude_known, initial_attitude_known);
QUORIENT_SAME(quorient_msgs_ClusterDescription, ClusterDescription, padding, padding);

static_assert(std::is_trivially_copyable_v<SensorFrame> && sizeof(quorient_msgs_SensorFrame) == sizeof(SensorFrame));
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, epoch, epoch);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, sequence_number, sequence);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, sample_time_ns, sample_time_ns);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, interval_s, interval_s);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, increment, increment);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, accumulated, accumulated);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, known_input, known_input);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, stamp_ns, stamp_ns);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, missed, missed);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, unit, unit);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, valid_mask, valid_mask);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, description_revision, description_revision);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, kind, kind);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, axis_count, axis_count);
QUORIENT_SAME(quorient_msgs_SensorFrame, SensorFrame, padding, padding);

static_assert(std::is_trivially_copyable_v<TruthState> && sizeof(quorient_msgs_TruthState) == sizeof(TruthState));
QUORIENT_SAME(quorient_msgs_TruthState, TruthState, epoch, epoch);
QUORIENT_SAME(quorient_msgs_TruthState, TruthState, sequence_number, sequence);
QUORIENT_SAME(quorient_msgs_TruthState, TruthState, sample_time_ns, sample_time_ns);
QUORIENT_SAME(quorient_msgs_TruthState, TruthState, attitude, attitude);
QUORIENT_SAME(quorient_msgs_TruthState, TruthState, rate_rad_s, rate_rad_s);
QUORIENT_SAME(quorient_msgs_TruthState, TruthState, unit, unit);
QUORIENT_SAME(quorient_msgs_TruthState, TruthState, faulty_mask, faulty_mask);
QUORIENT_SAME(quorient_msgs_TruthState, TruthState, attitude_known, attitude_known);
QUORIENT_SAME(quorient_msgs_TruthState, TruthState, padding, padding);

static_assert(std::is_trivially_copyable_v<FaultVerdict> && sizeof(quorient_msgs_FaultVerdict) == sizeof(FaultVerdict));
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, epoch, epoch);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, sequence_number, sequence);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, sample_time_ns, sample_time_ns);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, excluded_from, excluded_from);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, statistic, statistic);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, threshold, threshold);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, residual, residual);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, bound, bound);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, stamp_ns, stamp_ns);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, unit, unit);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, detector, detector);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, isolated_mask, isolated_mask);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, suspect_mask, suspect_mask);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, candidate_set, candidate_set);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, working_mask, working_mask);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, kind, kind);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, state, state);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, candidate_count, candidate_count);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, candidates_truncated, candidates_truncated);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, detectable_remaining, detectable_remaining);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, adopted, adopted);
QUORIENT_SAME(quorient_msgs_FaultVerdict, FaultVerdict, padding, padding);

static_assert(std::is_trivially_copyable_v<FaultDiagnosis> && sizeof(quorient_msgs_FaultDiagnosis) == sizeof(FaultDiagnosis));
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, epoch, epoch);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, sequence_number, sequence);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, sample_time_ns, sample_time_ns);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, size, size);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, sigma, sigma);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, bias, bias);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, bias_sigma, bias_sigma);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, unit, unit);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, detector, detector);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, provisional_mask, provisional_mask);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, absent_mask, absent_mask);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, degraded_mask, degraded_mask);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, diagnosis, diagnosis);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, kind, kind);
QUORIENT_SAME(quorient_msgs_FaultDiagnosis, FaultDiagnosis, padding, padding);

static_assert(std::is_trivially_copyable_v<AttitudeState> && sizeof(quorient_msgs_AttitudeState) == sizeof(AttitudeState));
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, epoch, epoch);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, sequence_number, sequence);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, sample_time_ns, sample_time_ns);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, verdict_epoch, verdict_epoch);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, verdict_sequence, verdict_sequence);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, attitude, attitude);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, reset_rotation, reset_rotation);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, rate_rad_s, rate_rad_s);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, angle_sigma_rad, angle_sigma_rad);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, excluded_from, excluded_from);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, stamp_ns, stamp_ns);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, unit, unit);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, lane, lane);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, used_mask, used_mask);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, isolated_mask, isolated_mask);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, suspect_mask, suspect_mask);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, rolled_back_frames, rolled_back_frames);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, reset_counter, reset_counter);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, mode, mode);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, seeded, seeded);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, bridged, bridged);
QUORIENT_SAME(quorient_msgs_AttitudeState, AttitudeState, padding, padding);

static_assert(std::is_trivially_copyable_v<VotedAttitude> && sizeof(quorient_msgs_VoterOutput) == sizeof(VotedAttitude));
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, epoch, epoch);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, sequence_number, sequence);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, sample_time_ns, sample_time_ns);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, output_sequence, output_sequence);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, attitude, attitude);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, reset_rotation, reset_rotation);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, rate_rad_s, rate_rad_s);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, angle_sigma_rad, angle_sigma_rad);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, spread_rad, spread_rad);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, excluded_from, excluded_from);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, stamp_ns, stamp_ns);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, unit, unit);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, voter, voter);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, primary_lane, primary_lane);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, vouching_mask, vouching_mask);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, excluded_mask, excluded_mask);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, used_mask, used_mask);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, isolated_mask, isolated_mask);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, suspect_mask, suspect_mask);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, reset_counter, reset_counter);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, excluded_why, excluded_why);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, mode, mode);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, level, level);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, seeded, seeded);
QUORIENT_SAME(quorient_msgs_VoterOutput, VotedAttitude, bridged, bridged);

static_assert(std::is_trivially_copyable_v<VotedAttitude> && sizeof(quorient_msgs_VotedAttitude) == sizeof(VotedAttitude));
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, epoch, epoch);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, sequence_number, sequence);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, sample_time_ns, sample_time_ns);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, output_sequence, output_sequence);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, attitude, attitude);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, reset_rotation, reset_rotation);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, rate_rad_s, rate_rad_s);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, angle_sigma_rad, angle_sigma_rad);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, spread_rad, spread_rad);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, excluded_from, excluded_from);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, stamp_ns, stamp_ns);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, unit, unit);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, voter, voter);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, primary_lane, primary_lane);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, vouching_mask, vouching_mask);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, excluded_mask, excluded_mask);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, used_mask, used_mask);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, isolated_mask, isolated_mask);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, suspect_mask, suspect_mask);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, reset_counter, reset_counter);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, excluded_why, excluded_why);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, mode, mode);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, level, level);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, seeded, seeded);
QUORIENT_SAME(quorient_msgs_VotedAttitude, VotedAttitude, bridged, bridged);

static_assert(std::is_trivially_copyable_v<HealthEvent> && sizeof(quorient_msgs_HealthEvent) == sizeof(HealthEvent));
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, epoch, epoch);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, sequence_number, sequence);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, wall_time_ns, wall_time_ns);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, event_number, event_number);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, request, request);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, unit, unit);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, source, source);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, axes, axes);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, code, code);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, severity, severity);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, padding, padding);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, source_name, source_name);
QUORIENT_SAME(quorient_msgs_HealthEvent, HealthEvent, text, text);

static_assert(std::is_trivially_copyable_v<ServiceStatus> && sizeof(quorient_msgs_ServiceStatus) == sizeof(ServiceStatus));
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, wall_time_ns, wall_time_ns);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, epoch, epoch);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, sequence_number, sequence);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, received, received);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, published, published);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, gaps, gaps);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, duplicates, duplicates);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, late, late);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, foreign, foreign);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, rejected, rejected);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, latency_s, latency_s);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, unit, unit);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, service, service);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, matched, matched);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, process, process);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, role, role);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, state, state);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, vendor, vendor);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, transport, transport);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, padding, padding);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, name, name);
QUORIENT_SAME(quorient_msgs_ServiceStatus, ServiceStatus, version, version);

static_assert(std::is_trivially_copyable_v<FaultCommand> && sizeof(quorient_msgs_FaultCommand) == sizeof(FaultCommand));
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, request, request);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, value, value);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, start_s, start_s);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, end_s, end_s);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, frequency_hz, frequency_hz);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, period_s, period_s);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, attitude, attitude);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, unit, unit);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, axes, axes);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, action, action);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, kind, kind);
QUORIENT_SAME(quorient_msgs_FaultCommand, FaultCommand, padding, padding);

#undef QUORIENT_SAME

}  // namespace

const dds_topic_descriptor_t& descriptor_of(TypeId type)
{
    if (is_ros2(type)) return ros2_descriptor_of(type);
    static const std::array<const dds_topic_descriptor_t*, type_count> descriptors{
        &quorient_msgs_ClusterDescription_desc, &quorient_msgs_SensorFrame_desc,   &quorient_msgs_TruthState_desc,
        &quorient_msgs_FaultVerdict_desc,       &quorient_msgs_FaultDiagnosis_desc, &quorient_msgs_AttitudeState_desc,
        &quorient_msgs_VoterOutput_desc,        &quorient_msgs_VotedAttitude_desc,  &quorient_msgs_HealthEvent_desc,
        &quorient_msgs_ServiceStatus_desc,      &quorient_msgs_FaultCommand_desc};
    return *descriptors[static_cast<std::size_t>(type)];
}

}  // namespace quorient::bus::cyclonedds
