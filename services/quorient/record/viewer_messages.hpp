#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace quorient::record {

/// The voted attitude as viewers know it. The parent frame is called `reference`, the child `body`.
class ViewerMessages {
public:
    /// The noise of the axes gives the covariance of the rate.
    void describe(const ClusterDescription& description) { description_ = description; }

    /// Makes transform() and imu() of this sample. @param time_ns  since 1970, of both messages
    void make(const VotedAttitude& voted, std::uint64_t time_ns);

    /// foxglove.FrameTransform in JSON; empty while the attitude is not known (LOST, INITIALISING).
    const std::string& transform() const { return transform_; }

    /// sensor_msgs/msg/Imu in little-endian CDR; its orientation covariance begins with -1 while the attitude is not known.
    const std::vector<std::uint8_t>& imu() const { return imu_; }

private:
    ClusterDescription description_;
    std::string transform_;
    std::vector<std::uint8_t> imu_;
};

}  // namespace quorient::record
