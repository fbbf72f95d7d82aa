#include "observers/observer_readmission.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi {
namespace {

constexpr double met_again = 0.9;
constexpr double surely_healthy_s = 1;

}  // namespace

AxisMask ObserverReadmission::watch(const Detector& detector, double interval_s, AxisMask isolated, AxisMask newly, bool healthy)
{
    AxisMask returning = 0;
    all_healthy_s_ = healthy ? all_healthy_s_ + interval_s : 0;
    for (std::size_t channel = 0; channel < max_axes; ++channel) {
        Trial& trial = trial_[channel];
        if (has_axis(newly, channel)) trial = {.exposed = trial.usual >= 0, .usual = trial.usual, .excitation = trial.usual};
        if (!healthy && !has_axis(isolated, channel)) continue;
        const auto expectation = detector.expectation(channel);
        if (!expectation) continue;
        const double size = std::abs(expectation->value);
        if (all_healthy_s_ >= surely_healthy_s) trial.usual = size;
        if (!has_axis(isolated & ~newly, channel) || !trial.exposed) continue;
        if (!expectation->agrees) {
            trial.healthy_s = trial.largest = 0;
            continue;
        }
        trial.healthy_s += interval_s;
        trial.largest = std::max(trial.largest, size);
        if (trial.healthy_s < healthy_s_ || trial.largest < met_again * trial.excitation) continue;
        trial.exposed = false;
        returning |= axis_bit(channel);
    }
    return returning;
}

}  // namespace quorient::fdi
