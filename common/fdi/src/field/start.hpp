#pragma once

#include "field/first_second.hpp"
#include "field/framing.hpp"
#include "quorient/fdi/sensor_class.hpp"

namespace quorient::fdi::field {

/// The first second of every instrument. If it is a rest, its means are the biases; if one of these lies outside the class while the others
/// agree, that instrument is faulty from the start. An instrument that is switched on late has a first second of its own.
class Start {
public:
    Start(std::size_t instruments, double interval_s, const ClassFigures& figures);

    void reset();

    /// This instrument begins again.
    void forget(std::size_t m);

    /// @returns the instruments that end their first second with this frame.
    InstrumentSet add(const Frame& frame);

    InstrumentSet started() const { return started_; }
    bool rested(std::size_t m) const { return rested_.has(m); }

    /// This instrument's bias at rest counts as an error: what is taken out is the mean of the others'.
    void take_bias_of_others(std::size_t m);

    /// Taken out of all that this instrument measures [rad/s].
    Eigen::Vector3d bias(std::size_t m) const { return bias_.col(static_cast<Eigen::Index>(m)); }

    /// The instruments whose resting bias lies outside the class, among those of the latest call of add that returned any.
    struct OutsideClass {
        std::size_t instrument;
        std::size_t component;
        double bias_rad_s;
    };
    const std::optional<OutsideClass>& outside_class() const { return outside_class_; }

private:
    struct First {
        std::array<FirstSecond, component_count> of;

        Eigen::Vector3d mean() const { return {of[0].mean(), of[1].mean(), of[2].mean()}; }
        double largest_deviation() const;
    };

    bool is_rest(InstrumentSet ended) const;
    void check_class(InstrumentSet ended);
    /// The level of an instrument: the mean of its first second, or what it has read lately beyond its bias.
    double level(std::size_t m, std::size_t component, InstrumentSet ended) const;

    std::size_t count_;
    std::size_t frames_needed_;
    double recent_rate_;
    const ClassFigures& figures_;
    std::array<First, max_instruments> first_{};
    Eigen::Matrix<double, 3, max_instruments> recent_;  ///< what started instruments have read lately, their biases taken out
    InstrumentSet started_;
    InstrumentSet rested_;
    Eigen::Matrix<double, 3, max_instruments> bias_;
    std::optional<OutsideClass> outside_class_;
};

}  // namespace quorient::fdi::field
