#include "skewed/axis_frames.hpp"

#include "near_range.hpp"

namespace quorient::fdi::skewed {

bool AxisFrames::add(const Measurement& measurement)
{
    if (!(measurement.interval_s > 0)) return false;
    if (grid_.begins(measurement)) {
        building_ = {};
        building_.sequence = measurement.identity.sequence;
        building_.present = AxisSet::first(cluster_.size());
    }
    for (std::size_t i = 0; i < cluster_.size(); ++i) {
        if (!measurement.usable(i)) {
            building_.present.remove(i);
            continue;
        }
        const double increment = measurement.increment[i];
        building_.rate[i] += increment;
        if (is_near_range(increment, cluster_.range(static_cast<Eigen::Index>(i)), measurement.interval_s)) building_.near_range.add(i);
    }
    building_.interval_s += measurement.interval_s;
    if (!grid_.completes()) return false;

    frame_ = building_;
    for (std::size_t i = 0; i < cluster_.size(); ++i) frame_.rate[i] /= frame_.interval_s;
    frame_.follows = grid_.follows();
    return true;
}

}  // namespace quorient::fdi::skewed
