#include "axis_state.hpp"

#include "quorient/messages/meaning.hpp"

#include <algorithm>

namespace quorient::monitor {
namespace {

bool is_left_out(const LaneTick& lane, std::size_t axis)
{
    return has_axis(lane.provisional | provisional_mask(lane.verdict), axis);
}

/// What detectors report and no voter repeats.
AxisState condition(const LaneTick& lane, std::size_t axis)
{
    if (has_axis(lane.diagnosis.absent_mask, axis)) return AxisState::absent;
    if (state_of(lane.verdict) == VerdictState::saturated || diagnosis_of(lane.diagnosis, axis) == Diagnosis::saturated)
        return AxisState::saturated;
    if (has_axis(lane.diagnosis.degraded_mask, axis)) return AxisState::degraded;
    return AxisState::healthy;
}

AxisState by_voter(const VotedAttitude& voted, std::size_t axis)
{
    if (has_axis(voted.isolated_mask, axis)) return AxisState::isolated;
    if (has_axis(provisional_mask(voted), axis)) return AxisState::left_out;
    return has_axis(voted.suspect_mask, axis) ? AxisState::suspect : AxisState::healthy;
}

}  // namespace

std::string_view to_string(AxisState state)
{
    switch (state) {
        case AxisState::healthy:
            return "healthy";
        case AxisState::degraded:
            return "degraded";
        case AxisState::suspect:
            return "suspect";
        case AxisState::saturated:
            return "saturated";
        case AxisState::absent:
            return "absent";
        case AxisState::left_out:
            return "left out";
        case AxisState::isolated:
            return "isolated";
        default:
            return "no data";
    }
}

AxisState state_in_lane(const LaneTick& lane, std::size_t axis)
{
    if (!lane.fresh) return AxisState::unknown;
    if (has_axis(lane.verdict.isolated_mask, axis)) return AxisState::isolated;
    if (is_left_out(lane, axis)) return AxisState::left_out;
    const auto known = condition(lane, axis);
    return has_axis(lane.suspect, axis) ? std::max(known, AxisState::suspect) : known;
}

AxisState state_in_system(const Tick& tick, std::size_t lanes, std::size_t axis)
{
    auto gravest = tick.voted_fresh ? by_voter(tick.voted, axis) : AxisState::unknown;
    for (std::size_t place = 0; place < lanes; ++place) {
        const auto& lane = tick.lane[place];
        if (!lane.fresh) continue;
        gravest = std::max(gravest, tick.voted_fresh ? condition(lane, axis) : state_in_lane(lane, axis));
    }
    return gravest;
}

}  // namespace quorient::monitor
