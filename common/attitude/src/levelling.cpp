#include "quorient/attitude/levelling.hpp"

#include <cmath>

namespace quorient::attitude {

tl::expected<Quaternion, std::string> level(const Eigen::Vector3d& specific_force, double heading_rad)
{
    constexpr double gravity = 9.80665;
    const double felt = specific_force.stableNorm();
    if (!(std::abs(felt - gravity) <= 0.2 * gravity))
        return tl::unexpected("cannot level on a specific force of " + std::to_string(felt) +
                              " m/s^2: the body must be at rest (9.8 m/s^2, within 20 %)");
    if (!std::isfinite(heading_rad)) return tl::unexpected(std::string("the heading is not finite"));

    const double roll = std::atan2(specific_force.y(), specific_force.z());
    const double pitch = std::atan2(-specific_force.x(), std::hypot(specific_force.y(), specific_force.z()));
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    return Quaternion(AngleAxisd(heading_rad, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
                      AngleAxisd(roll, Vector3d::UnitX()));
}

}  // namespace quorient::attitude
