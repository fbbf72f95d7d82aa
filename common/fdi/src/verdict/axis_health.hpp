#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/stream_place.hpp"
#include "verdict/others_view.hpp"

#include <array>
#include <cstdint>

namespace quorient::fdi {

/// Why an axis proves itself broken.
enum class AxisFault : std::uint8_t {
    none,
    out_of_range,  ///< beyond its stated range by more than 2 %
    rail,          ///< at its range while the others see less than 80 % of it there, whichever one instrument is left out of them
    stuck,         ///< repeats one value while the others moved
    zero,          ///< stuck at exactly 0
};

/// Tests of single axes by their own values: a stuck or railed axis need not wait for parity.
///
/// Stuck: five equal values over 0.03 s or more, while the others moved by more than max(5 quanta, 10 sigma), whichever one of them is left out
/// (OthersView). Where too few axes are left for that, as on four, one of the others may be the faulty one, and this axis may just have turned round.
/// There it is stuck only if at least two others moved and its noise is of three quanta or more, so that it hardly ever repeats itself. Else the
/// method has to find it. Isolated axes do not count as others. Runs do not reach over lost frames. At rest a sound axis may repeat itself for ever.
/// sigma is the larger of the stated one and what the axis has shown against the others; the quantum is the stated one, or else the least step that
/// the axis has made. Values within 2.5 % of the range are not asked: beyond its range a sound axis repeats its limit.
///
/// An axis without data is no broken one: it is left out while it has none, and `absent` says so.
///
/// Not here, because without redundancy they look like motion: bias, scale, sign, spikes within the range. Parity finds them.
/// Allocates nothing.
class AxisHealth {
public:
    explicit AxisHealth(const geometry::SensorCluster& cluster);

    /// @param isolated  axes that are no witnesses against the others.
    /// @returns the axes broken in this frame (confirmation is the state machine's).
    AxisMask assess(const Measurement& measurement, AxisMask isolated = 0);

    /// What the newest frame said of each axis.
    AxisFault fault(std::size_t axis) const { return fault_[axis]; }

    /// Axes without data (NaN, not valid or late) in at least 8 of the last 32 frames, until they have had data for 8 frames.
    AxisMask absent() const { return absent_; }

    void reset();

private:
    /// One value and how long it has been repeated.
    struct Run {
        double rate = 0;
        bool known = false;
        unsigned repeats = 0;
        double seconds = 0;
        double lowest_high = 0;  ///< what the others measured during the run: all of them were below, above
        double highest_low = 0;
        bool compared = false;
        bool independent = true;                   ///< every comparison survives a fault of any one of the others
        std::array<double, max_axes> begin{};      ///< what all axes read when it began [rate]
        AxisMask moved = 0;                        ///< axes that have visibly left that value
    };
    /// How an axis usually behaves.
    struct Habit {
        double quantum = 0;         ///< least step so far; 0 = none yet
        double variance = 0;        ///< that of its differences to the others, from frame to frame
        double last_difference = 0;
        unsigned frames = 0;
    };

    AxisFault judge(const Measurement& measurement, std::size_t axis) const;
    bool is_stuck(std::size_t axis) const;
    bool rarely_repeats(std::size_t axis) const;
    double quantum(std::size_t axis) const;
    double visible_motion(std::size_t axis) const;
    bool is_near_range(const Measurement& measurement, std::size_t axis) const;
    bool is_railed(const Measurement& measurement, std::size_t axis) const;
    void count_absence(std::size_t axis, bool here);
    void follow(const Measurement& measurement, std::size_t axis);
    void repeat(const Measurement& measurement, std::size_t axis);
    void learn(std::size_t axis, double rate);

    geometry::SensorCluster cluster_;
    OthersView others_;
    AxisMask broken_ = 0;  ///< in the newest frame
    AxisMask trusted_ = 0;  ///< witnesses in the newest frame
    StreamPlace place_;  ///< behind the newest frame
    AxisMask absent_ = 0;
    std::array<std::uint32_t, max_axes> missing_{};  ///< bit k = without data k frames ago
    std::array<Run, max_axes> run_{};
    std::array<Habit, max_axes> habit_{};
    std::array<AxisFault, max_axes> fault_{};
};

}  // namespace quorient::fdi
