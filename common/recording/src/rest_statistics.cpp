#include "quorient/recording/rest_statistics.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr std::uint64_t fewest_samples = 10;

/// Running mean and sum of squared deviations [Welford 1962].
struct Moments {
    std::uint64_t count = 0;
    double mean = 0;
    double squares = 0;

    void add(double value)
    {
        ++count;
        const double deviation = value - mean;
        mean += deviation / static_cast<double>(count);
        squares += deviation * (value - mean);
    }

    double deviation() const { return std::sqrt(squares / static_cast<double>(count - 1)); }
};

}  // namespace

tl::expected<RestStatistics, std::string> rest_statistics(Reader& reader, double seconds, double moving_rad_s)
{
    std::array<Moments, max_axes> rate{};
    RestStatistics rest;
    rest.acceleration_mask = all_axes(reader.description().axis_count);
    std::array<Moments, max_axes> acceleration{};
    RecordedFrame frame;
    double intervals_s = 0;
    for (auto outcome = reader.next(frame); outcome != ReadOutcome::end; outcome = reader.next(frame)) {
        if (outcome == ReadOutcome::rejected) continue;
        if (static_cast<double>(frame.time_ns) * 1e-9 > seconds) break;
        for (std::size_t axis = 0; axis < frame.axis_count; ++axis)
            if (has_axis(frame.valid_mask, axis)) rate[axis].add(frame.increment[axis] / frame.interval_s);
        rest.acceleration_mask &= frame.acceleration_mask;
        for (std::size_t axis = 0; axis < frame.axis_count; ++axis) acceleration[axis].add(frame.acceleration_m_s2[axis]);
        ++rest.samples;
        intervals_s += frame.interval_s;
        rest.duration_s = static_cast<double>(frame.time_ns) * 1e-9;
    }
    for (std::size_t axis = 0; axis < reader.description().axis_count; ++axis) {
        const Moments& moments = rate[axis];
        if (moments.count < fewest_samples)
            return tl::unexpected(fmt::format("axis {} has {} samples in the first {} s; at least {} are needed", axis, moments.count,
                                              seconds, fewest_samples));
        if (moments.deviation() > moving_rad_s)
            return tl::unexpected(fmt::format("axis {} is not at rest in the first {} s: its rate deviates by {:.4f} rad/s (limit {:.4f})",
                                              axis, seconds, moments.deviation(), moving_rad_s));
        rest.acceleration_m_s2[axis] = acceleration[axis].mean;
        rest.bias_rad_s[axis] = moments.mean;
        rest.sigma_rad[axis] = moments.deviation() * intervals_s / static_cast<double>(rest.samples);
        if (moments.squares == 0.0) rest.constant_mask |= axis_bit(axis);
    }
    return rest;
}

}  // namespace quorient::recording
