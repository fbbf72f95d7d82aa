#include "detection_trial.hpp"

#include "quorient/diagnosis/px4_rule.hpp"
#include "quorient/attitude/integrator.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace quorient::studies {

using diagnosis::Px4Rule;

namespace {

constexpr std::size_t frames_before_exclusion = 20;  ///< that the integrators' polynomial windows see

double begin_s(const SensorFrame& frame)
{
    return static_cast<double>(frame.sample_time_ns) * 1e-9 - frame.interval_s;
}

/// Time from the fault's beginning to the end of this frame.
double delay_s(const RecordedArray& array, const Trial& trial, std::size_t at)
{
    return static_cast<double>(array.frames[at].sample_time_ns) * 1e-9 - begin_s(array.frames[trial.onset]);
}

/// What the isolation of these axes in this frame is worth.
Judgement worth(const Trial& trial, std::size_t at, AxisMask isolated)
{
    const bool named = has_axis(isolated, trial.axis) && (isolated & ~trial.allowed) == 0;
    return named && at >= trial.onset ? Judgement::right : Judgement::wrong;
}

void watch(const RecordedArray& array, const Trial& trial, std::size_t at, const FaultVerdict& verdict, Judged& judged)
{
    if (at >= trial.onset) judged.reaction.update(verdict, ~AxisMask{0}, delay_s(array, trial, at));
    if (verdict.isolated_mask != 0) judged.judgement = worth(trial, at, verdict.isolated_mask);
    else if (at >= trial.onset && state_of(verdict) == VerdictState::ambiguous) judged.judgement = Judgement::ambiguous;
}

/// The attitude after these frames, which the exclusion reached at the end.
rotation::Quaternion attitude_after(const std::vector<SensorFrame>& frames, std::size_t from, const geometry::SensorCluster& cluster,
                                    const FaultVerdict& verdict)
{
    attitude::IntegratorSettings settings;
    settings.history_s = 2 * horizon_s;
    auto integrator = attitude::Integrator::make(settings, cluster).value();
    for (std::size_t i = from; i < frames.size(); ++i) integrator.add(frames[i]);
    integrator.apply(verdict);
    while (integrator.work()) {
    }
    return rotation::from_array(integrator.state().attitude);
}

void compare_attitudes(const RecordedArray& array, const Trial& trial, const std::vector<SensorFrame>& frames, std::size_t first,
                       const FaultVerdict& verdict, TrialResult& result)
{
    FaultVerdict best_verdict = verdict;
    const std::uint64_t onset = array.frames[trial.onset].sequence;
    for (std::size_t axis = 0; axis < array.cluster.size(); ++axis)
        if (has_axis(verdict.isolated_mask, axis)) best_verdict.excluded_from[axis] = onset;
    const std::uint64_t excluded_from = verdict.excluded_from[trial.axis];
    const auto begins = [&](std::uint64_t sequence) {
        return std::lower_bound(frames.begin(), frames.end(), sequence,
                                [](const SensorFrame& f, std::uint64_t s) { return f.sequence < s; });
    };
    const auto earliest = static_cast<std::size_t>(begins(std::min(onset, excluded_from)) - frames.begin());
    const std::size_t from = earliest > frames_before_exclusion ? earliest - frames_before_exclusion : 0;
    const auto ours = attitude_after(frames, from, array.cluster, verdict);
    const auto best = attitude_after(frames, from, array.cluster, best_verdict);

    const auto excluded = static_cast<std::size_t>(begins(excluded_from) - frames.begin());
    const auto& h = array.cluster.axes;
    const Eigen::Vector3d share = (h.transpose() * h).inverse() * h.row(static_cast<Eigen::Index>(trial.axis)).transpose();
    result.onset_error_s = begin_s(frames[excluded]) - begin_s(frames[trial.onset - first]);
    result.attitude_error_rad = rotation::angle_between(ours, best);
    result.attitude_bound_rad = free_of_charge_rad + share.norm() * std::abs(trial.fault.value * result.onset_error_s);
}

}  // namespace

TrialResult play(const RecordedArray& array, const Trial& trial, fdi::FaultMonitor monitor)
{
    TrialResult result;
    simulation::FaultInjector injector(array.cluster, trial.onset);
    simulation::FaultSpec fault = trial.fault;
    fault.axes = axis_bit(trial.axis);
    fault.start_s = begin_s(array.frames[trial.onset]);
    [[maybe_unused]] const auto added = injector.add(fault);
    assert(added);
    Px4Rule px4(array.cluster);

    const std::size_t first = trial.onset > frames_before_fault ? trial.onset - frames_before_fault : 0;
    std::vector<SensorFrame> frames;
    AxisMask ours = 0;
    AxisMask theirs = 0;
    for (std::size_t i = first; i < array.frames.size() && (ours == 0 || theirs == 0); ++i) {
        SensorFrame frame = array.frames[i];
        if (begin_s(frame) > fault.start_s + horizon_s) break;
        injector.apply(frame, begin_s(frame));
        if (theirs == 0 && (theirs = px4.update(frame)) != 0) {
            FaultVerdict verdict;
            verdict.state = octet(VerdictState::isolated);
            verdict.isolated_mask = theirs;
            watch(array, trial, i, verdict, result.px4);
        }
        if (ours != 0) continue;
        frames.push_back(frame);
        const FaultVerdict& verdict = monitor.assess(frame);
        watch(array, trial, i, verdict, result.ours);
        ours = verdict.isolated_mask;
        if (result.ours.judgement == Judgement::right && fault.kind == FaultKind::bias)
            compare_attitudes(array, trial, frames, first, verdict, result);
    }
    return result;
}

}  // namespace quorient::studies
