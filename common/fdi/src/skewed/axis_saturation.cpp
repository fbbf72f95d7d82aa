#include "skewed/axis_saturation.hpp"

#include <cmath>

namespace quorient::fdi::skewed {

bool AxisSaturation::borne_out(std::size_t axis, const AxisFrame& frame, AxisSet compared, const Eigen::Vector3d& rate) const
{
    constexpr double borne_out_at = 0.8;  // of the range
    constexpr double alike = 0.5;
    const auto direction = cluster_.axes.row(static_cast<Eigen::Index>(axis));
    if (std::abs(direction.dot(rate)) > borne_out_at * cluster_.range(static_cast<Eigen::Index>(axis))) return true;
    for (std::size_t other = 0; other < cluster_.size(); ++other)
        if (other != axis && compared.has(other) && frame.near_range.has(other) &&
            std::abs(direction.dot(cluster_.axes.row(static_cast<Eigen::Index>(other)))) > alike)
            return true;
    return false;
}

}  // namespace quorient::fdi::skewed
