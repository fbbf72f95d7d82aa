#include "quorient/messages/words.hpp"

#include <algorithm>
#include <array>

namespace quorient {
namespace {

template <class Code>
struct Word {
    Code code;
    std::string_view text;
};

constexpr std::array sensor_kinds{Word{SensorKind::gyro, "gyro"}, Word{SensorKind::accelerometer, "accelerometer"},
                                  Word{SensorKind::vessel_rates, "vessel_rates"}};

constexpr std::array severities{Word{Severity::info, "INFO"}, Word{Severity::warning_low, "WARNING_LO"},
                                Word{Severity::warning_high, "WARNING_HI"}, Word{Severity::fatal, "FATAL"}};

constexpr std::array events{
    Word{EventCode::started, "STARTED"},
    Word{EventCode::ready, "READY"},
    Word{EventCode::goodbye, "GOODBYE"},
    Word{EventCode::suspect, "SUSPECT"},
    Word{EventCode::isolated, "ISOLATED"},
    Word{EventCode::ambiguous, "AMBIGUOUS"},
    Word{EventCode::blind, "BLIND"},
    Word{EventCode::readmitted, "READMITTED"},
    Word{EventCode::redundancy_exhausted, "REDUNDANCY_EXHAUSTED"},
    Word{EventCode::adopted, "ADOPTED"},
    Word{EventCode::left_out, "LEFT_OUT"},
    Word{EventCode::returned, "RETURNED"},
    Word{EventCode::saturated, "SATURATED"},
    Word{EventCode::rolled_back, "ROLLED_BACK"},
    Word{EventCode::history_too_short, "HISTORY_TOO_SHORT"},
    Word{EventCode::coasting, "COASTING"},
    Word{EventCode::lost, "LOST"},
    Word{EventCode::seeded, "SEEDED"},
    Word{EventCode::absent, "ABSENT"},
    Word{EventCode::present, "PRESENT"},
    Word{EventCode::degraded, "DEGRADED"},
    Word{EventCode::primary_changed, "PRIMARY_CHANGED"},
    Word{EventCode::lane_excluded, "LANE_EXCLUDED"},
    Word{EventCode::lane_returned, "LANE_RETURNED"},
    Word{EventCode::level_changed, "LEVEL_CHANGED"},
    Word{EventCode::ownership_taken, "OWNERSHIP_TAKEN"},
    Word{EventCode::foreign_publisher, "FOREIGN_PUBLISHER"},
    Word{EventCode::new_epoch, "NEW_EPOCH"},
    Word{EventCode::rejected_input, "REJECTED_INPUT"},
    Word{EventCode::gap_bridged, "GAP_BRIDGED"},
    Word{EventCode::no_match, "NO_MATCH"},
    Word{EventCode::incompatible_qos, "INCOMPATIBLE_QOS"},
    Word{EventCode::transport_fallback, "TRANSPORT_FALLBACK"},
    Word{EventCode::shared_memory_lost, "SHARED_MEMORY_LOST"},
    Word{EventCode::fault_injected, "FAULT_INJECTED"},
    Word{EventCode::fault_cleared, "FAULT_CLEARED"},
    Word{EventCode::command_done, "COMMAND_DONE"},
    Word{EventCode::command_refused, "COMMAND_REFUSED"},
    Word{EventCode::unknown_revision, "UNKNOWN_REVISION"},
    Word{EventCode::consumers_missing, "CONSUMERS_MISSING"},
    Word{EventCode::other_contract, "OTHER_CONTRACT"},
    Word{EventCode::security, "SECURITY"},
    Word{EventCode::overloaded, "OVERLOADED"},
    Word{EventCode::identity_expires, "IDENTITY_EXPIRES"},
};

constexpr std::array roles{Word{ServiceRole::sensor, "sensor"}, Word{ServiceRole::detector, "detector"},
                           Word{ServiceRole::integrator, "integrator"}, Word{ServiceRole::voter, "voter"},
                           Word{ServiceRole::monitor, "monitor"}};

constexpr std::array service_states{Word{ServiceState::starting, "STARTING"}, Word{ServiceState::ready, "READY"},
                                    Word{ServiceState::running, "RUNNING"}, Word{ServiceState::stopping, "STOPPING"}};

constexpr std::array verdict_states{
    Word{VerdictState::warming_up, "WARMING_UP"}, Word{VerdictState::healthy, "HEALTHY"},         Word{VerdictState::suspect, "SUSPECT"},
    Word{VerdictState::isolated, "ISOLATED"},     Word{VerdictState::ambiguous, "AMBIGUOUS"},     Word{VerdictState::blind, "BLIND"},
    Word{VerdictState::provisional, "PROVISIONAL"}, Word{VerdictState::saturated, "SATURATED"}};

constexpr std::array diagnoses{
    Word{Diagnosis::none, "none"},           Word{Diagnosis::bias, "bias"},         Word{Diagnosis::gain, "gain"},
    Word{Diagnosis::sign, "sign"},           Word{Diagnosis::delay, "delay"},       Word{Diagnosis::stuck, "stuck"},
    Word{Diagnosis::zero, "zero"},           Word{Diagnosis::saturated, "saturated"}, Word{Diagnosis::noise, "noise"},
    Word{Diagnosis::spikes, "spikes"},       Word{Diagnosis::mounting, "mounting"}, Word{Diagnosis::outside_class, "class"},
    Word{Diagnosis::erratic, "erratic"},     Word{Diagnosis::absent, "absent"}};

constexpr std::array modes{
    Word{AttitudeMode::initialising, "INITIALISING"}, Word{AttitudeMode::normal, "NORMAL"},     Word{AttitudeMode::ambiguous, "AMBIGUOUS"},
    Word{AttitudeMode::untrusted, "UNTRUSTED"},       Word{AttitudeMode::coasting, "COASTING"}, Word{AttitudeMode::lost, "LOST"},
    Word{AttitudeMode::truth, "TRUTH"}};

constexpr std::array levels{Word{VoteLevel::full, "FULL"}, Word{VoteLevel::degraded, "DEGRADED"}, Word{VoteLevel::single, "SINGLE"},
                            Word{VoteLevel::coasting, "COASTING"}, Word{VoteLevel::lost, "LOST"}};

constexpr std::array lane_exclusions{
    Word{LaneExclusion::none, "in"},                  Word{LaneExclusion::silent, "silent"},
    Word{LaneExclusion::initialising, "initialising"}, Word{LaneExclusion::disagrees, "disagrees"},
    Word{LaneExclusion::uncorroborated, "uncorroborated"}, Word{LaneExclusion::outvoted, "outvoted"},
    Word{LaneExclusion::untrusted, "untrusted"},      Word{LaneExclusion::invalid, "invalid"}};

constexpr std::array actions{Word{CommandAction::inject, "inject"}, Word{CommandAction::clear, "clear"},
                             Word{CommandAction::readmit, "readmit"}, Word{CommandAction::reset_attitude, "reset"}};

template <class Code, std::size_t Count>
std::string_view word_of(const std::array<Word<Code>, Count>& words, Code code, std::string_view otherwise)
{
    const auto found = std::find_if(words.begin(), words.end(), [code](const Word<Code>& word) { return word.code == code; });
    return found == words.end() ? otherwise : found->text;
}

}  // namespace

std::string_view to_string(SensorKind kind)
{
    return word_of(sensor_kinds, kind, "unknown");
}
std::string_view to_string(Severity severity)
{
    return word_of(severities, severity, "UNKNOWN");
}
std::string_view to_string(EventCode code)
{
    return word_of(events, code, "UNKNOWN");
}
std::string_view to_string(ServiceRole role)
{
    return word_of(roles, role, "unknown");
}
std::string_view to_string(ServiceState state)
{
    return word_of(service_states, state, "UNKNOWN");
}
std::string_view to_string(VerdictState state)
{
    return word_of(verdict_states, state, "UNKNOWN");
}
std::string_view to_string(Diagnosis diagnosis)
{
    return word_of(diagnoses, diagnosis, "unknown");
}
std::string_view to_string(AttitudeMode mode)
{
    return word_of(modes, mode, "UNKNOWN");
}
std::string_view to_string(VoteLevel level)
{
    return word_of(levels, level, "UNKNOWN");
}
std::string_view to_string(LaneExclusion why)
{
    return word_of(lane_exclusions, why, "unknown");
}
std::string_view to_string(CommandAction action)
{
    return word_of(actions, action, "unknown");
}

}  // namespace quorient
