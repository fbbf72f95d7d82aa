#include "attitude_events.hpp"

#include "quorient/messages/limits.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/words.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <fmt/format.h>
#include <bit>
#include <numbers>

namespace quorient::integrator {

void AttitudeEvents::report_changes(const AttitudeState& attitude, const ClusterDescription& description, std::uint64_t too_short)
{
    const auto identity = identity_of(attitude);
    report_correction(attitude, description);
    if (too_short > reported_too_short_) {
        reported_too_short_ = too_short;
        node_.report(EventCode::history_too_short, Severity::warning_high, identity, attitude.isolated_mask,
                     "a verdict reaches further back than the history: corrected as far as it goes");
    }
    if (attitude.bridged && !last_.bridged)
        node_.report_throttled(EventCode::gap_bridged, Severity::warning_low, identity, 0,
                               "frames are missing: bridged by the accumulated angles");
    if (attitude.seeded && !last_.seeded)
        node_.report(EventCode::seeded, Severity::info, identity, 0, "SEEDED: took over the voted attitude");
    report_mode(attitude);
    last_ = attitude;
}

void AttitudeEvents::report_correction(const AttitudeState& attitude, const ClusterDescription& description)
{
    if (attitude.rolled_back_frames == 0) return;
    const AxisMask without = all_axes(description.axis_count) & ~attitude.used_mask;
    node_.report(
        EventCode::rolled_back, Severity::info, identity_of(attitude), without,
        fmt::format("attitude corrected by {:.3g} deg: the last {} integrated again without {}; {} axes in use",
                    rotation::angle_of(attitude.reset_rotation) * 180 / std::numbers::pi,
                    attitude.rolled_back_frames == 1 ? std::string{"frame"} : fmt::format("{} frames", attitude.rolled_back_frames),
                    axis_names(description, without), std::popcount(attitude.used_mask)));
}

void AttitudeEvents::report_mode(const AttitudeState& attitude)
{
    const AttitudeMode mode = mode_of(attitude);
    if (mode == mode_of(last_)) return;
    if (mode == AttitudeMode::coasting)
        node_.report_throttled(EventCode::coasting, Severity::warning_high, identity_of(attitude), attitude.used_mask,
                               "COASTING: fewer than three trusted axes, the attitude is held");
    if (mode == AttitudeMode::lost)
        node_.report_throttled(EventCode::lost, Severity::warning_high, identity_of(attitude), 0,
                               "LOST: the rotation in between is not known; re-align with a reset of the attitude");
}

void AttitudeEvents::report_mending(Identity identity, const attitude::Integrator::Mending& mending, const ClusterDescription& description)
{
    const auto* what = mending.axes == 0 ? "SEEDED again: the attitude taken over was not to be trusted, the voted one is" : nullptr;
    node_.report(
        EventCode::seeded, Severity::info, identity, mending.axes,
        what ? what : fmt::format("SEEDED again: the attitude taken over had a fault of {} in it", axis_names(description, mending.axes)));
}

}  // namespace quorient::integrator
