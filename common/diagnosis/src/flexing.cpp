#include "flexing.hpp"

#include "rates.hpp"

#include <cmath>
#include <numbers>

namespace quorient::diagnosis {
namespace {

constexpr double divide_hz = 5;
constexpr double fast_enough_hz = 40;
constexpr double vibrates_rad_s = 0.7 * degree;  // root mean square above and below the divide
constexpr double alike = 0.1;                  // share by which gains may differ
constexpr double least_frames_for_gains = 500;

}  // namespace

void Flexing::add(std::size_t instrument, double interval_s, const Eigen::Vector3d& measured, const Eigen::Vector3d& others)
{
    const double weight = 1 - std::exp(-2 * std::numbers::pi * divide_hz * interval_s);
    for (std::size_t i = 0; i < 3; ++i) {
        Axis& axis = axes_[3 * instrument + i];
        const auto k = static_cast<Eigen::Index>(i);
        axis.fast = interval_s * fast_enough_hz < 1;
        axis.frames += 1;
        axis.low_measured += weight * (measured(k) - axis.low_measured);
        axis.low_others += weight * (others(k) - axis.low_others);
        const double high_measured = measured(k) - axis.low_measured;
        const double high_others = others(k) - axis.low_others;
        axis.low.products += axis.low_measured * axis.low_others;
        axis.low.squares += axis.low_others * axis.low_others;
        axis.high.products += high_measured * high_others;
        axis.high.squares += high_others * high_others;
    }
}

std::optional<Flexing::Ratio> Flexing::largest() const
{
    std::optional<Ratio> found;
    std::size_t differing = 0;
    for (std::size_t place = 0; place < axes_.size(); ++place) {
        const Axis& axis = axes_[place];
        const double needed = axis.frames * vibrates_rad_s * vibrates_rad_s;
        if (!axis.fast || axis.frames < least_frames_for_gains || axis.high.squares < needed || axis.low.squares < needed) continue;
        const double ratio = axis.high.gain() / axis.low.gain();
        if (std::abs(ratio - 1) > alike) ++differing;
        if (!found || std::abs(ratio - 1) > std::abs(found->ratio - 1)) found = Ratio{place / 3, place % 3, ratio, 0};
    }
    if (found) found->differing = differing;
    return found;
}

}  // namespace quorient::diagnosis
