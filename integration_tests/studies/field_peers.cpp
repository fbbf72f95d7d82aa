#include "field_peers.hpp"

#include "quorient/diagnosis/ardupilot_rule.hpp"
#include "quorient/messages/units.hpp"

#include <algorithm>

namespace quorient::studies {
namespace {

constexpr double first_s = 1;
constexpr double rest_deviation = 0.5 * degree;
constexpr double moving_rate = 10 * degree;

double time_s(const SensorFrame& frame)
{
    return static_cast<double>(frame.sample_time_ns) * 1e-9;
}

/// Means of a resting first second; nothing where the log moves there [rad/s].
std::optional<std::vector<double>> resting_bias(const FieldLog& log, std::size_t from)
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
    if (count == 0) return std::nullopt;
    for (std::size_t axis = 0; axis < axes; ++axis) {
        sum[axis] /= count;
        if (squares[axis] / count - sum[axis] * sum[axis] > rest_deviation * rest_deviation) return std::nullopt;
    }
    return sum;
}

/// How many frames of a log lie before its first motion.
std::size_t resting_frames(const FieldLog& log)
{
    const auto bias = resting_bias(log, 0);
    if (!bias) return 0;
    Body body(log.cluster);
    const auto moves = [&](SensorFrame frame) {
        if (frame.valid_mask != log.cluster.all()) return false;
        for (std::size_t axis = 0; axis < bias->size(); ++axis) frame.increment[axis] -= (*bias)[axis] * frame.interval_s;
        return body.increment(frame, log.cluster.all()).norm() > moving_rate * frame.interval_s;
    };
    return static_cast<std::size_t>(std::ranges::find_if(log.frames, moves) - log.frames.begin());
}

}  // namespace

Px4OnLog::Px4OnLog(const FieldLog& log, std::size_t from)
    : all_(log.cluster.all()), rule_(log.cluster), bias_(resting_bias(log, from).value_or(std::vector<double>(log.cluster.size(), 0)))
{
}

AxisMask Px4OnLog::update(SensorFrame frame)
{
    if (frame.valid_mask != all_) return 0;
    for (std::size_t axis = 0; axis < bias_.size(); ++axis) frame.increment[axis] -= bias_[axis] * frame.interval_s;
    return rule_.update(frame);
}

bool refuses_to_arm(const FieldLog& log, const Injection& injection, std::uint64_t seed)
{
    diagnosis::ArduPilotRule rule;
    Spoiler spoiler(log, injection, seed);
    Body body(log.cluster);
    std::vector<Eigen::Vector3d> rates(log.instruments());
    const std::size_t end = resting_frames(log);
    for (std::size_t k = 0; k < end; ++k) {
        SensorFrame frame = log.frames[k];
        spoiler.apply(k, frame);
        if (frame.valid_mask != log.cluster.all()) continue;
        for (std::size_t m = 0; m < rates.size(); ++m) rates[m] = body.increment(frame, log.cluster.axes_of(m)) / frame.interval_s;
        const bool refused = rule.refusal().has_value();
        rule.update(time_s(frame), rates);
        if (!refused && rule.refusal()) return k >= injection.onset;
    }
    return false;
}

void FlownByOne::add(const SensorFrame& spoiled, const SensorFrame& as_logged)
{
    spoiled_.add(spoiled);
    sound_.add(as_logged);
}

AttitudeError FlownByOne::error(std::optional<std::size_t> changed) const
{
    AttitudeError error;
    const std::size_t flown = std::min(changed.value_or(size()), size());
    for (std::size_t k = 0; k < flown; ++k)
        error.largest_rad = std::max(error.largest_rad, rotation::angle_between(spoiled_.after(k), sound_.after(k)));
    if (!changed && size() > 0) error.at_end_rad = rotation::angle_between(spoiled_.after(size() - 1), sound_.after(size() - 1));
    return error;
}

}  // namespace quorient::studies
