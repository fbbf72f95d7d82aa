#include "field_trial.hpp"

#include "quorient/diagnosis/px4_rule.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>

namespace quorient::studies {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double lead_s = 60;    ///< played before the onset, at most
constexpr double follow_s = 20;  ///< and after it
constexpr double first_s = 1;
constexpr double rest_deviation = 0.5 * degree;

double time_s(const SensorFrame& frame)
{
    return static_cast<double>(frame.sample_time_ns) * 1e-9;
}

/// Means of a resting first second, which PX4's rule is given; zero where the log begins in motion [rad/s].
std::vector<double> resting_bias(const FieldLog& log, std::size_t from)
{
    const std::size_t axes = log.cluster.size();
    std::vector<double> sum(axes);
    std::vector<double> squares(axes);
    double count = 0;
    for (std::size_t k = from; k < log.frames.size() && time_s(log.frames[k]) < time_s(log.frames[from]) + first_s; ++k) {
        if (log.frames[k].valid_mask != log.cluster.all()) continue;
        for (std::size_t axis = 0; axis < axes; ++axis) {
            const double rate = log.frames[k].increment[axis] / log.frames[k].interval_s;
            sum[axis] += rate;
            squares[axis] += rate * rate;
        }
        ++count;
    }
    for (std::size_t axis = 0; axis < axes; ++axis) {
        sum[axis] /= count;
        if (squares[axis] / count - sum[axis] * sum[axis] > rest_deviation * rest_deviation) return std::vector<double>(axes, 0);
    }
    return sum;
}

/// PX4's rule on frames without their start biases; frames with a missing axis are passed over.
class Px4OnLog {
public:
    Px4OnLog(const FieldLog& log, std::size_t from) : all_(log.cluster.all()), rule_(log.cluster), bias_(resting_bias(log, from)) {}

    AxisMask update(SensorFrame frame)
    {
        if (frame.valid_mask != all_) return 0;
        for (std::size_t axis = 0; axis < bias_.size(); ++axis) frame.increment[axis] -= bias_[axis] * frame.interval_s;
        return rule_.update(frame);
    }

private:
    AxisMask all_;
    diagnosis::Px4Rule rule_;
    std::vector<double> bias_;
};

/// Increments of the body from the axes in use.
class Body {
public:
    explicit Body(const geometry::SensorCluster& cluster) : cluster_(cluster) {}

    Eigen::Vector3d increment(const SensorFrame& frame, AxisMask used)
    {
        const auto [found, fresh] = inverse_.try_emplace(used);
        if (fresh) {
            geometry::Axes h = cluster_.axes;
            for (std::size_t axis = 0; axis < cluster_.size(); ++axis)
                if (!has_axis(used, axis)) h.row(static_cast<Eigen::Index>(axis)).setZero();
            found->second = (h.transpose() * h).completeOrthogonalDecomposition().pseudoInverse() * h.transpose();
        }
        return found->second * Eigen::Map<const Eigen::VectorXd>(frame.increment.data(), cluster_.axes.rows());
    }

private:
    const geometry::SensorCluster& cluster_;
    std::map<AxisMask, Eigen::MatrixXd> inverse_;
};

/// An attitude with the memory to leave axes out afterwards.
class Attitude {
public:
    explicit Attitude(const geometry::SensorCluster& cluster) : body_(cluster), all_(cluster.all()) {}

    void add(const SensorFrame& frame)
    {
        frames_.push_back(frame);
        left_out_.push_back(0);
    }

    void leave_out(const FaultVerdict& verdict)
    {
        for (AxisMask rest = verdict.excluded_from.mask(); rest != 0; rest &= rest - 1) {
            const auto axis = static_cast<std::size_t>(std::countr_zero(rest));
            for (std::size_t k = frames_.size(); k-- > 0 && frames_[k].sequence >= verdict.excluded_from[axis];) {
                if (has_axis(left_out_[k], axis)) break;
                left_out_[k] |= axis_bit(axis);
            }
        }
    }

    rotation::Quaternion at_end()
    {
        rotation::Quaternion attitude = rotation::Quaternion::Identity();
        for (std::size_t k = 0; k < frames_.size(); ++k)
            attitude = attitude * rotation::from_rotation_vector(body_.increment(frames_[k], all_ & frames_[k].valid_mask & ~left_out_[k]));
        return attitude;
    }

    /// Since which frame of the log this axis is left out, at the end.
    const std::vector<AxisMask>& left_out() const { return left_out_; }

private:
    Body body_;
    AxisMask all_;
    std::vector<SensorFrame> frames_;
    std::vector<AxisMask> left_out_;
};

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

FaultRun play_fault(const FieldLog& log, const Injection& injection, std::uint64_t seed, fdi::FaultMonitor monitor)
{
    FaultRun run;
    Spoiler spoiler(log, injection, seed);
    const double onset_s = time_s(log.frames[injection.onset]) - log.frames[injection.onset].interval_s;
    const auto first = std::ranges::lower_bound(log.frames, onset_s - lead_s, {}, time_s) - log.frames.begin();
    Px4OnLog px4(log, static_cast<std::size_t>(first));
    Attitude ours(log.cluster);
    Attitude truth(log.cluster);
    const AxisMask faulty = log.cluster.axes_of(injection.instrument);
    FaultVerdict without_fault;
    AxisMask px4_blames = 0;
    AxisMask latched = 0;
    for (auto k = static_cast<std::size_t>(first); k < log.frames.size() && time_s(log.frames[k]) < onset_s + follow_s; ++k) {
        SensorFrame frame = log.frames[k];
        const double since = time_s(frame) - onset_s;
        spoiler.apply(k, frame);
        const FaultVerdict& verdict = monitor.assess(frame);
        if (k >= injection.onset) {
            ours.add(frame);
            ours.leave_out(verdict);
            truth.add(log.frames[k]);
        }
        const AxisMask wrong = k < injection.onset ? verdict.isolated_mask : verdict.isolated_mask & ~faulty;
        if (wrong != 0 && run.wrong == 0) run.wrong_s = since;
        run.wrong |= wrong;
        latched = verdict.isolated_mask;
        const bool out = (verdict.excluded_from.mask() & faulty) != 0;
        if (k >= injection.onset && out) run.protected_s = std::min(run.protected_s, since);
        if (k >= injection.onset && (verdict.isolated_mask & faulty) != 0) run.latched_s = std::min(run.latched_s, since);
        if (px4_blames != 0 || (px4_blames = px4.update(frame)) == 0) continue;
        run.px4_wrong = px4_blames != faulty || k < injection.onset;
        run.px4_s = since;
    }
    run.diagnosis = monitor.diagnosis();
    read(run.diagnosis, injection, run);
    run.injected = fmt::format("{}, {} of axis {} at {:.2f} s", log.name, injection.fault.name, injection.axis,
                               onset_s - time_s(log.frames.front()));
    const AxisMask never_right = injection.fault.passes ? 0 : faulty;
    without_fault.excluded_from.exclude((latched & faulty) != 0 ? latched & faulty : never_right, 0);
    truth.leave_out(without_fault);
    run.attitude_error_rad = rotation::angle_between(ours.at_end(), truth.at_end());
    return run;
}

}  // namespace quorient::studies
