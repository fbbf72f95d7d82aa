#pragma once

#include "field/first_second.hpp"
#include "quorient/fdi/sensor_class.hpp"
#include "skewed/axis_frames.hpp"

#include <optional>

namespace quorient::fdi::skewed {

/// The first second of every axis. If it is a rest, its mean is the bias; if the means contradict each other by more than the class allows, and
/// one axis explains that, it is faulty from the start. An axis that is switched on late has a first second of its own.
class AxisStart {
public:
    AxisStart(const geometry::Axes& axes, double interval_s, const ClassFigures& figures);

    void reset();

    /// This axis begins again.
    void forget(std::size_t axis);

    /// @returns the axes that end their first second with this frame.
    AxisSet add(const AxisFrame& frame);

    AxisSet started() const { return started_; }
    bool rested(std::size_t axis) const { return rested_.has(axis); }
    double bias(std::size_t axis) const { return bias_[axis]; }  ///< taken out of all that this axis measures [rad/s]

    /// The axis whose resting bias lies outside the class, among those of the latest call of add that returned any.
    std::optional<std::size_t> outside_class() const { return outside_class_; }

    /// This axis' bias at rest counts as an error: nothing is taken out.
    void distrust(std::size_t axis);

private:
    bool is_rest(AxisSet ended) const;
    void check_class(AxisSet ended);
    /// The mean of the first second, or what an axis has read lately beyond its bias.
    double level(std::size_t axis, AxisSet ended) const { return ended.has(axis) ? first_[axis].mean() : recent_[axis]; }

    const geometry::Axes& axes_;
    std::size_t count_;
    std::size_t frames_needed_;
    double recent_rate_;
    const ClassFigures& figures_;
    std::array<field::FirstSecond, max_axes> first_{};
    PerAxis recent_{};
    PerAxis bias_{};
    AxisSet started_;
    AxisSet rested_;
    std::optional<std::size_t> outside_class_;
};

}  // namespace quorient::fdi::skewed
