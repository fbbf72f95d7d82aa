#pragma once

#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/fault_command.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/health_event.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/service_status.hpp"
#include "quorient/messages/truth_state.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <tuple>
#include <utility>

namespace quorient {

/// A member of a message and its name in the IDL (`sequence` is a word of the IDL language, hence sequence_number there).
template <class Message, class Type>
struct Field {
    const char* name;
    Type Message::*member;
};
template <class Message, class Type>
Field(const char*, Type Message::*) -> Field<Message, Type>;  // clang before 17 deduces nothing for an aggregate by itself

/// All members of a message in the order of the wire: what echo prints, tests fill and compare, and the vendors' types are checked against.
template <class Message>
struct Fields;

template <>
struct Fields<ClusterDescription> {
    using M = ClusterDescription;
    static constexpr auto all = std::tuple{Field{"epoch", &M::epoch},
                                           Field{"interval_s", &M::interval_s},
                                           Field{"axis", &M::axis},
                                           Field{"position_m", &M::position_m},
                                           Field{"sigma", &M::sigma},
                                           Field{"quantum", &M::quantum},
                                           Field{"range", &M::range},
                                           Field{"bias", &M::bias},
                                           Field{"initial_attitude", &M::initial_attitude},
                                           Field{"unit", &M::unit},
                                           Field{"revision", &M::revision},
                                           Field{"instrument", &M::instrument},
                                           Field{"instrument_name", &M::instrument_name},
                                           Field{"name", &M::name},
                                           Field{"kind", &M::kind},
                                           Field{"axis_count", &M::axis_count},
                                           Field{"instrument_count", &M::instrument_count},
                                           Field{"initial_attitude_known", &M::initial_attitude_known},
                                           Field{"padding", &M::padding}};
};

template <>
struct Fields<SensorFrame> {
    using M = SensorFrame;
    static constexpr auto all = std::tuple{Field{"epoch", &M::epoch},
                                           Field{"sequence_number", &M::sequence},
                                           Field{"sample_time_ns", &M::sample_time_ns},
                                           Field{"interval_s", &M::interval_s},
                                           Field{"increment", &M::increment},
                                           Field{"accumulated", &M::accumulated},
                                           Field{"known_input", &M::known_input},
                                           Field{"stamp_ns", &M::stamp_ns},
                                           Field{"missed", &M::missed},
                                           Field{"unit", &M::unit},
                                           Field{"valid_mask", &M::valid_mask},
                                           Field{"description_revision", &M::description_revision},
                                           Field{"kind", &M::kind},
                                           Field{"axis_count", &M::axis_count},
                                           Field{"padding", &M::padding}};
};

template <>
struct Fields<TruthState> {
    using M = TruthState;
    static constexpr auto all = std::tuple{Field{"epoch", &M::epoch},
                                           Field{"sequence_number", &M::sequence},
                                           Field{"sample_time_ns", &M::sample_time_ns},
                                           Field{"attitude", &M::attitude},
                                           Field{"rate_rad_s", &M::rate_rad_s},
                                           Field{"unit", &M::unit},
                                           Field{"faulty_mask", &M::faulty_mask},
                                           Field{"attitude_known", &M::attitude_known},
                                           Field{"padding", &M::padding}};
};

template <>
struct Fields<FaultVerdict> {
    using M = FaultVerdict;
    static constexpr auto all = std::tuple{Field{"epoch", &M::epoch},
                                           Field{"sequence_number", &M::sequence},
                                           Field{"sample_time_ns", &M::sample_time_ns},
                                           Field{"excluded_from", &M::excluded_from},
                                           Field{"statistic", &M::statistic},
                                           Field{"threshold", &M::threshold},
                                           Field{"residual", &M::residual},
                                           Field{"bound", &M::bound},
                                           Field{"stamp_ns", &M::stamp_ns},
                                           Field{"unit", &M::unit},
                                           Field{"detector", &M::detector},
                                           Field{"isolated_mask", &M::isolated_mask},
                                           Field{"suspect_mask", &M::suspect_mask},
                                           Field{"candidate_set", &M::candidate_set},
                                           Field{"working_mask", &M::working_mask},
                                           Field{"kind", &M::kind},
                                           Field{"state", &M::state},
                                           Field{"candidate_count", &M::candidate_count},
                                           Field{"candidates_truncated", &M::candidates_truncated},
                                           Field{"detectable_remaining", &M::detectable_remaining},
                                           Field{"adopted", &M::adopted},
                                           Field{"padding", &M::padding}};
};

template <>
struct Fields<FaultDiagnosis> {
    using M = FaultDiagnosis;
    static constexpr auto all = std::tuple{Field{"epoch", &M::epoch},
                                           Field{"sequence_number", &M::sequence},
                                           Field{"sample_time_ns", &M::sample_time_ns},
                                           Field{"size", &M::size},
                                           Field{"sigma", &M::sigma},
                                           Field{"bias", &M::bias},
                                           Field{"bias_sigma", &M::bias_sigma},
                                           Field{"unit", &M::unit},
                                           Field{"detector", &M::detector},
                                           Field{"provisional_mask", &M::provisional_mask},
                                           Field{"absent_mask", &M::absent_mask},
                                           Field{"degraded_mask", &M::degraded_mask},
                                           Field{"diagnosis", &M::diagnosis},
                                           Field{"kind", &M::kind},
                                           Field{"padding", &M::padding}};
};

template <>
struct Fields<AttitudeState> {
    using M = AttitudeState;
    static constexpr auto all = std::tuple{Field{"epoch", &M::epoch},
                                           Field{"sequence_number", &M::sequence},
                                           Field{"sample_time_ns", &M::sample_time_ns},
                                           Field{"verdict_epoch", &M::verdict_epoch},
                                           Field{"verdict_sequence", &M::verdict_sequence},
                                           Field{"attitude", &M::attitude},
                                           Field{"reset_rotation", &M::reset_rotation},
                                           Field{"rate_rad_s", &M::rate_rad_s},
                                           Field{"angle_sigma_rad", &M::angle_sigma_rad},
                                           Field{"excluded_from", &M::excluded_from},
                                           Field{"stamp_ns", &M::stamp_ns},
                                           Field{"unit", &M::unit},
                                           Field{"lane", &M::lane},
                                           Field{"used_mask", &M::used_mask},
                                           Field{"isolated_mask", &M::isolated_mask},
                                           Field{"suspect_mask", &M::suspect_mask},
                                           Field{"rolled_back_frames", &M::rolled_back_frames},
                                           Field{"reset_counter", &M::reset_counter},
                                           Field{"mode", &M::mode},
                                           Field{"seeded", &M::seeded},
                                           Field{"bridged", &M::bridged},
                                           Field{"padding", &M::padding}};
};

template <>
struct Fields<VotedAttitude> {
    using M = VotedAttitude;
    static constexpr auto all = std::tuple{Field{"epoch", &M::epoch},
                                           Field{"sequence_number", &M::sequence},
                                           Field{"sample_time_ns", &M::sample_time_ns},
                                           Field{"output_sequence", &M::output_sequence},
                                           Field{"attitude", &M::attitude},
                                           Field{"reset_rotation", &M::reset_rotation},
                                           Field{"rate_rad_s", &M::rate_rad_s},
                                           Field{"angle_sigma_rad", &M::angle_sigma_rad},
                                           Field{"spread_rad", &M::spread_rad},
                                           Field{"excluded_from", &M::excluded_from},
                                           Field{"stamp_ns", &M::stamp_ns},
                                           Field{"unit", &M::unit},
                                           Field{"voter", &M::voter},
                                           Field{"primary_lane", &M::primary_lane},
                                           Field{"vouching_mask", &M::vouching_mask},
                                           Field{"excluded_mask", &M::excluded_mask},
                                           Field{"used_mask", &M::used_mask},
                                           Field{"isolated_mask", &M::isolated_mask},
                                           Field{"suspect_mask", &M::suspect_mask},
                                           Field{"reset_counter", &M::reset_counter},
                                           Field{"excluded_why", &M::excluded_why},
                                           Field{"mode", &M::mode},
                                           Field{"level", &M::level},
                                           Field{"seeded", &M::seeded},
                                           Field{"bridged", &M::bridged}};
};

template <>
struct Fields<HealthEvent> {
    using M = HealthEvent;
    static constexpr auto all = std::tuple{Field{"epoch", &M::epoch},
                                           Field{"sequence_number", &M::sequence},
                                           Field{"wall_time_ns", &M::wall_time_ns},
                                           Field{"event_number", &M::event_number},
                                           Field{"request", &M::request},
                                           Field{"unit", &M::unit},
                                           Field{"source", &M::source},
                                           Field{"axes", &M::axes},
                                           Field{"code", &M::code},
                                           Field{"severity", &M::severity},
                                           Field{"padding", &M::padding},
                                           Field{"source_name", &M::source_name},
                                           Field{"text", &M::text}};
};

template <>
struct Fields<ServiceStatus> {
    using M = ServiceStatus;
    static constexpr auto all = std::tuple{Field{"wall_time_ns", &M::wall_time_ns},
                                           Field{"epoch", &M::epoch},
                                           Field{"sequence_number", &M::sequence},
                                           Field{"received", &M::received},
                                           Field{"published", &M::published},
                                           Field{"gaps", &M::gaps},
                                           Field{"duplicates", &M::duplicates},
                                           Field{"late", &M::late},
                                           Field{"foreign", &M::foreign},
                                           Field{"rejected", &M::rejected},
                                           Field{"latency_s", &M::latency_s},
                                           Field{"unit", &M::unit},
                                           Field{"service", &M::service},
                                           Field{"matched", &M::matched},
                                           Field{"process", &M::process},
                                           Field{"role", &M::role},
                                           Field{"state", &M::state},
                                           Field{"vendor", &M::vendor},
                                           Field{"transport", &M::transport},
                                           Field{"padding", &M::padding},
                                           Field{"name", &M::name},
                                           Field{"version", &M::version}};
};

template <>
struct Fields<FaultCommand> {
    using M = FaultCommand;
    static constexpr auto all = std::tuple{Field{"request", &M::request},
                                           Field{"value", &M::value},
                                           Field{"start_s", &M::start_s},
                                           Field{"end_s", &M::end_s},
                                           Field{"frequency_hz", &M::frequency_hz},
                                           Field{"period_s", &M::period_s},
                                           Field{"attitude", &M::attitude},
                                           Field{"unit", &M::unit},
                                           Field{"axes", &M::axes},
                                           Field{"action", &M::action},
                                           Field{"kind", &M::kind},
                                           Field{"padding", &M::padding}};
};

/// Calls function(name, value) for every member.
template <class Message, class Function>
void for_each_field(Message& message, Function&& function)
{
    std::apply([&](const auto&... field) { (function(field.name, message.*(field.member)), ...); },
               Fields<std::remove_const_t<Message>>::all);
}

}  // namespace quorient
