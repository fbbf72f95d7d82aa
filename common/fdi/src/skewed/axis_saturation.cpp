#include "skewed/axis_saturation.hpp"

#include <cmath>

namespace quorient::fdi::skewed {

bool AxisSaturation::borne_out(std::size_t axis, const AxisFrame& frame, AxisSet compared, const Eigen::Vector3d& rate) const
{
    constexpr double borne_out_at = 0.8;  // as a part of the range
    const auto direction = cluster_.axes.row(static_cast<Eigen::Index>(axis));
    if (std::abs(direction.dot(rate)) > borne_out_at * cluster_.range(static_cast<Eigen::Index>(axis))) return true;
    AxisSet others = frame.near_range & compared;
    others.remove(axis);
    return !others.empty();
}

}  // namespace quorient::fdi::skewed
