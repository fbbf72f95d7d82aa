#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/parity_space.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <array>
#include <cstdint>

namespace quorient::fdi {

/// Why an axis proves itself broken.
enum class AxisFault : std::uint8_t {
    none,
    absent,        ///< NaN, not valid or late in at least 8 of the last 32 frames
    out_of_range,  ///< beyond its stated range by more than 2 %
    rail,          ///< at its range while the others see less than 80 % of it there, whichever one instrument is left out of them
    frozen,        ///< bitwise the same while it should have moved, or for longer than its noise ever allows
    zero,          ///< frozen at exactly 0
};

/// Tests of single axes by their own values: a dead, frozen or railed axis need not wait for parity.
///
/// Frozen: two or more bitwise repeats (three equal values) in frames in which the other axes say that this one moved, and is elsewhere, by
/// more than six standard deviations (at a turning point of its own motion a sound axis repeats itself however wildly the others move); or,
/// without such help, so many repeats that an axis which repeats as often as this one used to would show them once in 1e9 tries. A single
/// repeat is normal on real hardware. Not asked of axes whose noise is below a quarter of their quantum (these may repeat for ever), nor of
/// values within 2.5 % of the range (in a motion beyond it a sound axis repeats its limit).
///
/// Not here, because without redundancy they look like motion: bias, scale, sign, spikes within the range. Parity finds them.
/// Allocates nothing.
class AxisHealth {
public:
    explicit AxisHealth(const geometry::SensorCluster& cluster);

    /// @returns the axes broken in this frame (confirmation is the state machine's).
    AxisMask assess(const Measurement& measurement);

    /// What the newest frame said of each axis.
    AxisFault fault(std::size_t axis) const { return fault_[axis]; }

    void reset();

private:
    struct History {
        double last = 0;
        bool known = false;
        double predicted = 0;  ///< by the other axes, for the newest frame
        bool is_predicted = false;
        std::uint32_t absent_frames = 0;  ///< bit k = absent k frames ago
        unsigned repeats = 0;             ///< in a row, up to the newest frame
        unsigned repeats_in_motion = 0;
        double seen = 0;  ///< frames and repeats that the habit is known from
        double repeated = 0;
    };

    void predict(const Measurement& measurement);
    void work_with(AxisMask used);
    AxisFault judge(const Measurement& measurement, std::size_t axis) const;
    bool is_frozen(const History& history) const;
    bool is_near_range(const Measurement& measurement, std::size_t axis) const;
    bool is_railed(const Measurement& measurement, std::size_t axis) const;
    void remember(const Measurement& measurement, std::size_t axis);

    geometry::SensorCluster cluster_;
    geometry::ParitySpace space_;  ///< of the axes that are there and sound
    bool spans_ = false;           ///< these axes span space
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_axes)> least_squares_;  ///< the body from them
    geometry::AxisVector moving_step_;     ///< a change beyond which an axis moves
    AxisMask noisy_ = 0;                   ///< axes whose noise shakes their last bit
    AxisMask broken_ = 0;                  ///< in the newest frame
    std::array<bool, max_axes> moving_{};  ///< the others say that this axis moved since the frame before
    std::array<History, max_axes> history_{};
    std::array<AxisFault, max_axes> fault_{};
};

}  // namespace quorient::fdi
