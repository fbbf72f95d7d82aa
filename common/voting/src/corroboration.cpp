#include "corroboration.hpp"

#include "quorient/messages/codes.hpp"
#include "quorient/messages/left_out.hpp"
#include "quorient/messages/meaning.hpp"
#include "timeline.hpp"

#include <algorithm>

namespace quorient::voting {
namespace {

AxisMask candidates(const FaultVerdict& verdict)
{
    AxisMask axes = 0;
    const std::size_t count = std::min<std::size_t>(verdict.candidate_count, max_candidates);
    for (std::size_t set = 0; set < count; ++set) axes |= verdict.candidate_set[set];
    return axes;
}

bool sees_trouble(const FaultVerdict& verdict)
{
    const auto state = state_of(verdict);
    return state == VerdictState::suspect || state == VerdictState::ambiguous || state == VerdictState::provisional;
}

bool is_tested(const FaultVerdict& verdict)
{
    return state_of(verdict) != VerdictState::unknown && state_of(verdict) != VerdictState::warming_up;
}

}  // namespace

bool Corroboration::on_verdict(std::size_t lane, const FaultVerdict& verdict, Identity newest, std::int64_t now_ns)
{
    LaneReport& last = lane_reports_[lane];
    const Identity identity = identity_of(verdict);
    const bool strays = last.received && last.identity.epoch != newest.epoch && identity.epoch == newest.epoch;
    if (last.received && identity <= last.identity && !strays) return false;
    if (newest.epoch == identity.epoch && identity.sequence > newest.sequence + frame_window) return false;

    const bool trouble = sees_trouble(verdict);
    const AxisMask all = all_axes(max_axes);
    const AxisMask isolated = verdict.isolated_mask & all;
    const AxisMask provisional = left_out_mask(verdict) & ~verdict.isolated_mask & all;
    const bool onset = (trouble && !last.troubled) || isolated != last.isolated || (provisional & ~last.provisional) != 0;
    last.identity = identity;
    last.received_ns = now_ns;
    last.received = true;
    last.troubled = trouble;
    last.isolated = isolated;
    last.provisional = provisional;
    last.suspected = (verdict.suspect_mask | candidates(verdict)) & all;
    last.exhausted = is_tested(verdict) && verdict.detectable_remaining == 0;
    if (onset) open(last, identity, reported(last, now_ns), now_ns);
    return true;
}

void Corroboration::on_sample(std::size_t lane, const AttitudeState& sample, std::int64_t now_ns)
{
    LaneReport& last = lane_reports_[lane];
    const AxisMask all = all_axes(max_axes);
    const AxisMask applied = sample.isolated_mask & all;
    const AxisMask doubted = (sample.suspect_mask | (left_out_mask(sample) & ~sample.isolated_mask)) & all;
    const bool onset = last.applied != applied || (doubted & ~last.doubted) != 0;
    last.applied = applied;
    last.doubted = doubted;
    if (onset) open(last, identity_of(sample), last.applied | last.doubted, now_ns);
}

void Corroboration::on_published(Identity identity, std::int64_t now_ns)
{
    std::size_t troubled = 0;
    for (std::size_t lane = 0; lane < lanes_; ++lane) troubled += fresh(lane_reports_[lane], now_ns) && lane_reports_[lane].troubled ? 1 : 0;
    if (troubled < majority_) return;
    settle_epoch_ = identity.epoch;
    settle_until_ = identity.sequence + 1 + settle_frames_;
}

AxisMask Corroboration::corroborated(std::int64_t now_ns) const
{
    std::array<std::uint8_t, max_axes> reports{};
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const AxisMask axes = reported(lane_reports_[lane], now_ns);
        for (std::size_t axis = 0; axes >> axis != 0; ++axis)
            reports[axis] = static_cast<std::uint8_t>(reports[axis] + (axes >> axis & 1U));
    }
    AxisMask agreed = 0;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        if (reports[axis] >= majority_) agreed |= axis_bit(axis);
    }
    return agreed;
}

bool Corroboration::reports(std::size_t lane, std::int64_t now_ns) const
{
    return fresh(lane_reports_[lane], now_ns);
}

bool Corroboration::knows_better(std::size_t lane, AxisMask left_out, std::int64_t now_ns) const
{
    const AxisMask more = (lane_reports_[lane].isolated | lane_reports_[lane].applied) & ~left_out;
    return more != 0 && (more & corroborated(now_ns)) != 0;
}

bool Corroboration::redundancy_exhausted(std::size_t lane) const
{
    return lane_reports_[lane].exhausted;
}

AxisMask Corroboration::reported(const LaneReport& last, std::int64_t now_ns) const
{
    const AxisMask suspected = fresh(last, now_ns) ? last.suspected | last.provisional : 0;
    return last.isolated | last.applied | last.doubted | suspected;
}

/// One lane alone can hold off exclusions only once in a while; where its axes are corroborated, at every step it takes.
void Corroboration::open(LaneReport& last, Identity identity, AxisMask axes, std::int64_t now_ns)
{
    const bool shared = axes != 0 && (axes & ~corroborated(now_ns)) == 0;
    const bool recently = last.opened_once && identity.epoch == settle_epoch_ && identity.sequence < last.opened_at + reopen_frames_;
    if (recently && !shared) return;
    last.opened_once = true;
    last.opened_at = identity.sequence;
    const std::uint64_t until = identity.sequence + 1 + settle_frames_;
    settle_until_ = identity.epoch == settle_epoch_ ? std::max(settle_until_, until) : until;
    settle_epoch_ = identity.epoch;
}

}  // namespace quorient::voting
