#include "quorient/runtime/words.hpp"

namespace quorient::runtime {

std::string_view to_string(Severity severity)
{
    switch (severity) {
        case Severity::info:
            return "INFO";
        case Severity::warning_low:
            return "WARNING_LO";
        case Severity::warning_high:
            return "WARNING_HI";
        case Severity::fatal:
            return "FATAL";
        case Severity::unknown:
            break;
    }
    return "UNKNOWN";
}

std::string_view to_string(EventCode code)
{
    switch (code) {
        case EventCode::started:
            return "STARTED";
        case EventCode::ready:
            return "READY";
        case EventCode::goodbye:
            return "GOODBYE";
        case EventCode::suspect:
            return "SUSPECT";
        case EventCode::isolated:
            return "ISOLATED";
        case EventCode::ambiguous:
            return "AMBIGUOUS";
        case EventCode::blind:
            return "BLIND";
        case EventCode::readmitted:
            return "READMITTED";
        case EventCode::redundancy_exhausted:
            return "REDUNDANCY_EXHAUSTED";
        case EventCode::adopted:
            return "ADOPTED";
        case EventCode::rolled_back:
            return "ROLLED_BACK";
        case EventCode::history_too_short:
            return "HISTORY_TOO_SHORT";
        case EventCode::coasting:
            return "COASTING";
        case EventCode::lost:
            return "LOST";
        case EventCode::seeded:
            return "SEEDED";
        case EventCode::primary_changed:
            return "PRIMARY_CHANGED";
        case EventCode::lane_excluded:
            return "LANE_EXCLUDED";
        case EventCode::lane_returned:
            return "LANE_RETURNED";
        case EventCode::level_changed:
            return "LEVEL_CHANGED";
        case EventCode::ownership_taken:
            return "OWNERSHIP_TAKEN";
        case EventCode::foreign_publisher:
            return "FOREIGN_PUBLISHER";
        case EventCode::new_epoch:
            return "NEW_EPOCH";
        case EventCode::rejected_input:
            return "REJECTED_INPUT";
        case EventCode::gap_bridged:
            return "GAP_BRIDGED";
        case EventCode::no_match:
            return "NO_MATCH";
        case EventCode::incompatible_qos:
            return "INCOMPATIBLE_QOS";
        case EventCode::transport_fallback:
            return "TRANSPORT_FALLBACK";
        case EventCode::shared_memory_lost:
            return "SHARED_MEMORY_LOST";
        case EventCode::fault_injected:
            return "FAULT_INJECTED";
        case EventCode::fault_cleared:
            return "FAULT_CLEARED";
        case EventCode::command_done:
            return "COMMAND_DONE";
        case EventCode::command_refused:
            return "COMMAND_REFUSED";
        case EventCode::unknown_revision:
            return "UNKNOWN_REVISION";
        case EventCode::consumers_missing:
            return "CONSUMERS_MISSING";
        case EventCode::unknown:
            break;
    }
    return "UNKNOWN";
}

std::string_view to_string(ServiceRole role)
{
    switch (role) {
        case ServiceRole::sensor:
            return "sensor";
        case ServiceRole::detector:
            return "detector";
        case ServiceRole::integrator:
            return "integrator";
        case ServiceRole::voter:
            return "voter";
        case ServiceRole::monitor:
            return "monitor";
        case ServiceRole::unknown:
            break;
    }
    return "unknown";
}

std::string_view to_string(ServiceState state)
{
    switch (state) {
        case ServiceState::starting:
            return "STARTING";
        case ServiceState::ready:
            return "READY";
        case ServiceState::running:
            return "RUNNING";
        case ServiceState::stopping:
            return "STOPPING";
        case ServiceState::unknown:
            break;
    }
    return "UNKNOWN";
}

std::string_view to_string(VerdictState state)
{
    switch (state) {
        case VerdictState::warming_up:
            return "WARMING_UP";
        case VerdictState::healthy:
            return "HEALTHY";
        case VerdictState::suspect:
            return "SUSPECT";
        case VerdictState::isolated:
            return "ISOLATED";
        case VerdictState::ambiguous:
            return "AMBIGUOUS";
        case VerdictState::blind:
            return "BLIND";
        case VerdictState::unknown:
            break;
    }
    return "UNKNOWN";
}

std::string_view to_string(AttitudeMode mode)
{
    switch (mode) {
        case AttitudeMode::initialising:
            return "INITIALISING";
        case AttitudeMode::normal:
            return "NORMAL";
        case AttitudeMode::ambiguous:
            return "AMBIGUOUS";
        case AttitudeMode::untrusted:
            return "UNTRUSTED";
        case AttitudeMode::coasting:
            return "COASTING";
        case AttitudeMode::lost:
            return "LOST";
        case AttitudeMode::truth:
            return "TRUTH";
        case AttitudeMode::unknown:
            break;
    }
    return "UNKNOWN";
}

std::string_view to_string(VoteLevel level)
{
    switch (level) {
        case VoteLevel::full:
            return "FULL";
        case VoteLevel::degraded:
            return "DEGRADED";
        case VoteLevel::single:
            return "SINGLE";
        case VoteLevel::coasting:
            return "COASTING";
        case VoteLevel::lost:
            return "LOST";
        case VoteLevel::unknown:
            break;
    }
    return "UNKNOWN";
}

std::string_view to_string(LaneExclusion why)
{
    switch (why) {
        case LaneExclusion::none:
            return "in";
        case LaneExclusion::silent:
            return "silent";
        case LaneExclusion::initialising:
            return "initialising";
        case LaneExclusion::disagrees:
            return "disagrees";
        case LaneExclusion::uncorroborated:
            return "uncorroborated";
        case LaneExclusion::outvoted:
            return "outvoted";
        case LaneExclusion::untrusted:
            return "untrusted";
        case LaneExclusion::invalid:
            return "invalid";
    }
    return "unknown";
}

}  // namespace quorient::runtime
