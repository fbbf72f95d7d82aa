#include "run_timeline.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/rotation/euler.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quorient::report {

void RunMoment::add(const RunMoment& later)
{
    error_rad.add(later.error_rad);
    without_rollback_rad.add(later.without_rollback_rad);
    for (std::size_t i = 0; i < 3; ++i) roll_pitch_yaw_deg[i].add(later.roll_pitch_yaw_deg[i]);
    for (std::size_t place = 0; place < max_lanes; ++place) {
        Lane& its = lane[place];
        const Lane& other = later.lane[place];
        its.statistic.add(other.statistic);
        for (std::size_t axis = 0; axis < max_axes; ++axis) its.residual[axis].add(other.residual[axis]);
        its.isolated |= other.isolated;
        its.provisional |= other.provisional;
    }
    faulty |= later.faulty;
    level = std::max(level, later.level);
}

RunTimeline::RunTimeline(const system::System& system, evaluation::RunObserver& observer) : system_(system), moment_s_(system.interval_s)
{
    moments_.reserve(most_moments);
    observer.watch_errors([this, &observer](const evaluation::Errors& of, const TruthState& truth, double error_rad) {
        auto* moment = moment_at(truth.epoch, truth.sample_time_ns);
        if (!moment) return;
        if (&of == &observer.without_rollback()) moment->without_rollback_rad.add(error_rad);
        else moment->error_rad.add(error_rad);
    });
}

void RunTimeline::on_truth(const TruthState& truth)
{
    if (truth.unit != system_.unit) return;
    if (auto* moment = moment_at(truth.epoch, truth.sample_time_ns)) moment->faulty |= truth.faulty_mask;
}

void RunTimeline::on_verdict(const FaultVerdict& verdict)
{
    const auto lane = std::ranges::find(system_.lanes, verdict.detector, [](const auto& its) { return its.detector.detector; });
    if (verdict.unit != system_.unit || lane == system_.lanes.end()) return;
    auto* moment = moment_at(verdict.epoch, verdict.sample_time_ns);
    if (!moment) return;
    auto& its = moment->lane[static_cast<std::size_t>(lane - system_.lanes.begin())];
    if (verdict.threshold > 0) its.statistic.add(verdict.statistic / verdict.threshold);
    for (std::size_t axis = 0; axis < max_axes; ++axis)
        if (verdict.bound[axis] > 0) its.residual[axis].add(std::abs(verdict.residual[axis]) / verdict.bound[axis]);
    its.isolated |= verdict.isolated_mask;
    its.provisional |= provisional_mask(verdict);
}

/// Both voters send every frame: the first of each counts.
void RunTimeline::on_voted(const VotedAttitude& voted)
{
    if (voted.unit != system_.unit || identity_of(voted) <= newest_voted_) return;
    newest_voted_ = identity_of(voted);
    auto* moment = moment_at(voted.epoch, voted.sample_time_ns);
    if (!moment) return;
    moment->level = std::max(moment->level, level_of(voted));
    if (level_of(voted) == VoteLevel::lost || !rotation::is_attitude(voted.attitude)) return;
    const auto angles = rotation::roll_pitch_yaw(voted.attitude);
    for (std::size_t i = 0; i < 3; ++i) {
        const double wrapped_deg = angles[i] * 180 / std::numbers::pi;
        latest_angle_deg_[i] += std::remainder(wrapped_deg - latest_angle_deg_[i], 360.0);
        moment->roll_pitch_yaw_deg[i].add(latest_angle_deg_[i]);
    }
}

double RunTimeline::time_s(std::uint64_t epoch, std::int64_t sample_time_ns)
{
    const double own_s = static_cast<double>(sample_time_ns) * 1e-9;
    if (epoch != epoch_) {
        epoch_ = epoch;
        shift_s_ = moments_.empty() ? 0 : std::max(0.0, newest_s_ - own_s);
    }
    return own_s + shift_s_;
}

/// @returns nothing for a sample of an epoch that has ended, or from before the first.
RunMoment* RunTimeline::moment_at(std::uint64_t epoch, std::int64_t sample_time_ns)
{
    if (epoch < epoch_) return nullptr;
    const double time = time_s(epoch, sample_time_ns);
    if (moments_.empty()) begin_s_ = time;
    const auto place_of = [&] { return std::floor((time - begin_s_) / moment_s_ + 1e-6); };
    if (place_of() < 0) return nullptr;
    while (place_of() >= static_cast<double>(most_moments)) shorten();
    const auto place = static_cast<std::size_t>(place_of());
    if (place >= moments_.size()) moments_.resize(place + 1);
    newest_s_ = std::max(newest_s_, time);
    return &moments_[place];
}

void RunTimeline::shorten()
{
    const std::size_t half = (moments_.size() + 1) / 2;
    for (std::size_t i = 0; i < half; ++i) {
        if (i > 0) moments_[i] = moments_[2 * i];
        if (2 * i + 1 < moments_.size()) moments_[i].add(moments_[2 * i + 1]);
    }
    moments_.resize(half);
    moment_s_ *= 2;
}

}  // namespace quorient::report
