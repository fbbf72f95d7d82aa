#include "quorient/recording/end_of_range.hpp"

namespace quorient::recording {
namespace {

/// No gyro for vehicles has a smaller range.
constexpr double smallest_range_rad_s = 100.0 * 3.14159265358979323846 / 180.0;

/// The ends of both signs differ by one of 32768 where codes are two's complements.
constexpr double same_value = 1.0 - 1e-4;
constexpr double near_value = 0.97;

/// A sine that passes the range by 5 % is there three times as long as close below it.
constexpr std::uint64_t times_more = 3;
constexpr std::uint64_t least_samples = 20;
constexpr std::uint64_t least_visits = 3;
constexpr std::uint64_t least_stay = 2;  // samples of a visit, on average

}  // namespace

void EndOfRange::add(double size_rad_s, std::int64_t time_ns)
{
    if (size_rad_s * same_value > at_end_.range_rad_s) {
        near_end_ = at_end_.range_rad_s >= near_value * size_rad_s ? near_end_ + at_end_.samples : 0;
        at_end_ = {size_rad_s, 0, time_ns, time_ns};
        visits_ = 0;
        there_ = false;
    }
    const bool there = size_rad_s >= same_value * at_end_.range_rad_s;
    if (there) {
        ++at_end_.samples;
        at_end_.last_ns = time_ns;
        if (!there_) ++visits_;
    } else if (size_rad_s >= near_value * at_end_.range_rad_s) {
        ++near_end_;
    }
    there_ = there;
}

std::optional<Clipping> EndOfRange::clipping() const
{
    const bool often = at_end_.samples >= least_samples && visits_ >= least_visits && at_end_.samples >= least_stay * visits_;
    if (at_end_.range_rad_s < smallest_range_rad_s || !often || at_end_.samples < times_more * near_end_) return std::nullopt;
    return at_end_;
}

}  // namespace quorient::recording
