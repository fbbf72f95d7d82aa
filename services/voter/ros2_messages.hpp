#pragma once

#include "quorient/bus/ros2.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/voting/voter_settings.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quorient::voter {

/// Covariance [rad^2/s^2] of the body rate that the axes of `used` measure over one interval, from their noise and quantum:
/// (H' W H)^-1 / interval^2, W = 1 / (sigma^2 + quantum^2 / 12). All 0 (for ROS 2: not known) where they measure no rotation, or state
/// no noise.
std::array<double, 9> rate_covariance(const ClusterDescription& description, AxisMask used);

/// The voted attitude as ROS 2 knows an IMU. The orientation's variance about each axis is a third of angle_sigma_rad^2; its first
/// element is -1 where there is no orientation (LOST, INITIALISING). No acceleration: -1.
bus::ros2::Imu to_imu(const VotedAttitude& voted, const std::array<double, 9>& rate_covariance);

/// An instrument's clock on the host's: sample times of an epoch are shifted by the smallest delay met in it, so that stamps keep the
/// instrument's spacing and are never later than their arrival.
class HostTime {
public:
    /// @returns nanoseconds since 1970.
    std::int64_t of(const VotedAttitude& voted, std::int64_t wall_now_ns);

private:
    std::uint64_t epoch_ = 0;
    std::int64_t offset_ns_ = 0;
};

/// A voter, as the others receive it.
struct VoterPresence {
    std::uint32_t voter = 0;
    bool alive = false;
};

/// One status per axis, lane and voter; what does not fit is left out from the end.
void to_diagnostics(const VotedAttitude& voted, const ClusterDescription* description, const std::vector<voting::LaneSettings>& lanes,
                    const std::vector<VoterPresence>& voters, bus::ros2::DiagnosticArray& array);

}  // namespace quorient::voter
