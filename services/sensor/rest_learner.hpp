#pragma once

#include "quorient/messages/limits.hpp"
#include "quorient/messages/sensor_frame.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace quorient::sensor {

/// Biases and noise of gyros that rest, from the raw frames before a unit's first one.
///
/// The cluster rests while, over half a second, the median instrument is quiet (below 0.02 rad/s about its mean), turns slower than
/// 0.05 rad/s, and its mean stays within 0.02 rad/s of that before. The median decides, so that one faulty instrument does not hide a rest.
/// An axis learns nothing that is beyond what the class `consumer`, the widest, allows, or that comes from less than half of the frames.
/// Not seen: a slow, steady turn, which looks like a bias common to all.
class RestLearner {
public:
    enum class State : std::uint8_t {
        learning,
        rested,  ///< long enough; the figures hold
        moving,  ///< it moves, or moved before it had rested long enough: nothing is learned
    };

    /// @param instrument  of each axis
    /// @param rest_s      that is wanted; not above 0: nothing is learned, state() is moving
    RestLearner(std::vector<std::size_t> instrument, double rest_s);

    State state() const { return state_; }

    /// One raw frame, while the state is learning.
    void add(const SensorFrame& raw);

    /// Axes whose bias is known once it has rested.
    AxisMask learned() const { return learned_; }
    double bias_rad_s(std::size_t axis) const { return axes_[axis].mean; }

    /// Standard deviation of one increment [rad].
    double sigma_rad(std::size_t axis) const;

private:
    /// Mean and squares by Welford's recurrence.
    struct Figures {
        std::uint64_t count = 0;
        double mean = 0;
        double squares = 0;

        void add(double value);
        double deviation() const;
    };
    using Axes = std::array<Figures, max_axes>;

    void end_block();
    bool block_rests() const;
    void conclude();
    template <class Figure>
    double median_of_instruments(Figure figure) const;

    std::vector<std::size_t> instrument_;
    std::size_t instruments_ = 0;
    double rest_s_;
    State state_;
    Axes axes_{};
    Axes block_{};  ///< the half second in hand
    double block_s_ = 0;
    double rested_s_ = 0;
    double interval_s_ = 0;
    std::uint64_t frames_ = 0;
    AxisMask learned_ = 0;
};

}  // namespace quorient::sensor
