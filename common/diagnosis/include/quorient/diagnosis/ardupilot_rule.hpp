#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace quorient::diagnosis {

/// For comparison: ArduPilot's check of several gyros, written from its description. Before arming, and only then, each gyro is compared with
/// the first one: a vector difference of more than 5 deg/s refuses arming, until all have agreed for ten seconds. In flight gyros are not
/// compared with each other.
class ArduPilotRule {
public:
    /// @param rates  of all gyros in one frame, in the body frame, the first gyro's first [rad/s]; before the vehicle moves
    void update(double time_s, std::span<const Eigen::Vector3d> rates);

    struct Refusal {
        std::size_t gyro = 0;
        double difference_rad_s = 0;
        double at_s = 0;  ///< first
        double last_s = 0;
    };
    const std::optional<Refusal>& refusal() const { return refusal_; }

private:
    std::optional<Refusal> refusal_;
};

}  // namespace quorient::diagnosis
