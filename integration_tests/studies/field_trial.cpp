#include "field_trial.hpp"

#include "field_peers.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace quorient::studies {
namespace {

constexpr double lead_s = 60;    ///< played before the onset, at most
constexpr double follow_s = 20;  ///< and after it

double time_s(const SensorFrame& frame)
{
    return static_cast<double>(frame.sample_time_ns) * 1e-9;
}

/// What the diagnosis says of the faulty axis.
void read(const FaultDiagnosis& diagnosis, const Injection& injection, FaultRun& run)
{
    bool others = false;
    for (std::size_t axis = 3 * injection.instrument; axis < 3 * injection.instrument + 3; ++axis)
        others = others || (axis != injection.axis && diagnosis_of(diagnosis, axis) != Diagnosis::none);
    const Diagnosis kind = diagnosis_of(diagnosis, injection.axis);
    run.named_axis = kind != Diagnosis::none && (injection.fault.whole || !others);
    run.named_kind = kind == injection.fault.kind;
    const double size = diagnosis.size[injection.axis];
    if (run.named_kind && kind == Diagnosis::bias && injection.fault.spoil == Spoil::bias)
        run.size_error = std::abs(size - injection.sign * injection.fault.size);
    if (run.named_kind && kind == Diagnosis::gain) run.size_error = std::abs(size - injection.fault.size);
}

}  // namespace

SoundRun play_sound(const FieldLog& log, fdi::FaultMonitor monitor)
{
    SoundRun run;
    Px4OnLog px4(log, 0);
    AxisMask out = 0;
    const double begin = time_s(log.frames.front());
    for (const SensorFrame& frame : log.frames) {
        const FaultVerdict& verdict = monitor.assess(frame);
        const double now = time_s(frame) - begin;
        if (verdict.isolated_mask != 0 && run.latched == 0) run.first_latched_s = now;
        run.latched |= verdict.isolated_mask;
        const AxisMask left_out = provisional_mask(verdict);
        if ((left_out & ~out) != 0) ++run.provisional_times;
        out = left_out;
        if (left_out != 0) run.provisional_s += frame.interval_s;
        if (state_of(verdict) == VerdictState::saturated) run.saturated_s += frame.interval_s;
        if (monitor.assessment().degraded != 0) run.degraded_s += frame.interval_s;
        if (run.px4 == 0 && (run.px4 = px4.update(frame)) != 0) run.px4_s = now;
    }
    run.diagnosis = monitor.diagnosis();
    return run;
}

namespace {

/// The attitudes that result from one fault.
class Attitudes {
public:
    Attitudes(const FieldLog& log, AxisMask faulty)
        : ours_(log.cluster, log.cluster.all()), truth_(log.cluster, log.cluster.all()), by_one_(log.cluster, faulty)
    {
    }

    void add(const SensorFrame& spoiled, const SensorFrame& as_logged, const FaultVerdict& verdict)
    {
        ours_.add(spoiled);
        ours_.leave_out(verdict.excluded_from);
        as_known_.push_back(ours_.after(ours_.size() - 1));
        truth_.add(as_logged);
        by_one_.add(spoiled, as_logged);
    }

    /// @param away  axes that the unspoiled attitude does without
    AttitudeError ours(AxisMask away)
    {
        Exclusions without;
        without.exclude(away, 0);
        truth_.leave_out(without);
        AttitudeError error;
        for (std::size_t k = 0; k < as_known_.size(); ++k) {
            error.at_end_rad = rotation::angle_between(as_known_[k], truth_.after(k));
            error.largest_rad = std::max(error.largest_rad, error.at_end_rad);
        }
        return error;
    }

    const FlownByOne& by_one() const { return by_one_; }

private:
    Attitude ours_;
    Attitude truth_;
    FlownByOne by_one_;
    std::vector<rotation::Quaternion> as_known_;
};

/// What PX4's rule does with one fault.
class Px4Trial {
public:
    Px4Trial(const FieldLog& log, std::size_t first, AxisMask faulty) : rule_(log, first), faulty_(faulty) {}

    /// @param since_s  the onset
    /// @param flown    frames since the onset, with this one; 0 before it
    void update(const SensorFrame& frame, double since_s, std::size_t flown)
    {
        if (blames_ != 0 || (blames_ = rule_.update(frame)) == 0) return;
        px4_.wrong = blames_ != faulty_ || flown == 0;
        px4_.named_s = since_s;
        if (!px4_.wrong) changed_ = flown;
    }

    FaultRun::Px4 result(const FlownByOne& attitude)
    {
        px4_.attitude = attitude.error(changed_);
        return px4_;
    }

private:
    Px4OnLog rule_;
    AxisMask faulty_;
    AxisMask blames_ = 0;
    std::optional<std::size_t> changed_;
    FaultRun::Px4 px4_;
};

}  // namespace

FaultRun play_fault(const FieldLog& log, const Injection& injection, std::uint64_t seed, fdi::FaultMonitor monitor)
{
    FaultRun run;
    Spoiler spoiler(log, injection, seed);
    const double onset_s = time_s(log.frames[injection.onset]) - log.frames[injection.onset].interval_s;
    const auto first = static_cast<std::size_t>(std::ranges::lower_bound(log.frames, onset_s - lead_s, {}, time_s) - log.frames.begin());
    const AxisMask faulty = log.cluster.axes_of(injection.instrument);
    Px4Trial px4(log, first, faulty);
    Attitudes attitudes(log, faulty);
    AxisMask latched = 0;
    for (std::size_t k = first; k < log.frames.size() && time_s(log.frames[k]) < onset_s + follow_s; ++k) {
        SensorFrame frame = log.frames[k];
        const double since = time_s(frame) - onset_s;
        spoiler.apply(k, frame);
        const FaultVerdict& verdict = monitor.assess(frame);
        const bool begun = k >= injection.onset;
        if (begun) attitudes.add(frame, log.frames[k], verdict);
        px4.update(frame, since, attitudes.by_one().size());
        latched = verdict.isolated_mask;
        const AxisMask wrong = begun ? latched & ~faulty : latched;
        if (wrong != 0 && run.wrong == 0) run.wrong_s = since;
        run.wrong |= wrong;
        if (begun && (verdict.excluded_from.mask() & faulty) != 0) run.protected_s = std::min(run.protected_s, since);
        if (begun && (latched & faulty) != 0) run.latched_s = std::min(run.latched_s, since);
    }
    run.diagnosis = monitor.diagnosis();
    read(run.diagnosis, injection, run);
    run.injected = fmt::format("{}, {} of axis {} at {:.2f} s", log.name, injection.fault.name, injection.axis,
                               onset_s - time_s(log.frames.front()));
    const AxisMask never_right = injection.fault.passes ? 0 : faulty;
    run.attitude = attitudes.ours((latched & faulty) != 0 ? latched & faulty : never_right);
    run.px4 = px4.result(attitudes.by_one());
    run.ardupilot = {refuses_to_arm(log, injection, seed), attitudes.by_one().error({})};
    return run;
}

}  // namespace quorient::studies
