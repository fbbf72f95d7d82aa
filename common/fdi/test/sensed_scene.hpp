#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace quorient::fdi {

constexpr double degree = std::numbers::pi / 180;

/// Gyros on one body, frame by frame. The truth is known: their differences, the motion, and what a test spoils.
class SensedScene {
public:
    using Rates = std::vector<double>;  ///< deg/s, one per axis

    virtual ~SensedScene() = default;

    /// A flight: slow turns, manoeuvres, and the vibration that all feel; up to 350 deg/s.
    static Eigen::Vector3d flight(double t)
    {
        return {120 * std::sin(2.1 * t) + 60 * std::sin(7.3 * t + 1) + 4 * std::sin(60 * t),
                90 * std::sin(1.3 * t + 2) + 80 * std::cos(5.9 * t) + 5 * std::sin(71 * t),
                150 * std::sin(0.9 * t) + 40 * std::sin(9.1 * t) + 3 * std::sin(83 * t)};
    }
    static Eigen::Vector3d rest(double) { return Eigen::Vector3d::Zero(); }
    /// A rest of so many seconds, then a flight.
    static std::function<Eigen::Vector3d(double)> flight_after(double seconds)
    {
        return [seconds](double t) -> Eigen::Vector3d {
            return t < seconds ? rest(t) : Eigen::Vector3d(flight(t - seconds) * std::min(1.0, t - seconds));
        };
    }

    std::function<Eigen::Vector3d(double)> motion = flight_after(2);  ///< the body's [deg/s]
    std::function<void(std::uint64_t sequence, Rates&)> spoil = [](std::uint64_t, Rates&) {};

    /// The next measurement; NaN where an axis has no data.
    Measurement next()
    {
        rates_.clear();
        measure(time_s(), rates_);
        spoil(sequence_, rates_);
        increments_.clear();
        AxisMask valid = 0;
        for (std::size_t axis = 0; axis < rates_.size(); ++axis) {
            increments_.push_back(rates_[axis] * degree * interval_s_);
            if (std::isfinite(rates_[axis])) valid |= axis_bit(axis);
        }
        return {.identity = {1, sequence_++}, .interval_s = interval_s_, .increment = increments_, .valid = valid};
    }

    std::uint64_t sequence() const { return sequence_; }
    double time_s() const { return static_cast<double>(sequence_) * interval_s_; }
    double normal() { return normal_(random_); }

    static constexpr double range_deg_s = 2000;
    geometry::SensorCluster cluster;

protected:
    SensedScene(std::uint64_t seed, double interval_s) : interval_s_(interval_s), random_(seed) {}
    SensedScene(const SensedScene&) = default;
    SensedScene(SensedScene&&) = default;
    SensedScene& operator=(const SensedScene&) = default;
    SensedScene& operator=(SensedScene&&) = default;

    /// Appends what each axis measures at this time, before a test spoils it.
    virtual void measure(double t, Rates& rates) = 0;

    double interval_s() const { return interval_s_; }
    double between(double least, double most) { return std::uniform_real_distribution<double>(least, most)(random_); }
    double any_phase() { return 2 * std::numbers::pi * between(0, 1); }

    /// As a sensor of this step gives it out, within its range.
    static double digitised(double rate_deg_s, double quantum_deg_s)
    {
        if (quantum_deg_s > 0) rate_deg_s = std::round(rate_deg_s / quantum_deg_s) * quantum_deg_s;
        return std::clamp(rate_deg_s, -range_deg_s, range_deg_s);
    }

private:
    double interval_s_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    Rates rates_;
    std::vector<double> increments_;
    std::uint64_t sequence_ = 0;
};

}  // namespace quorient::fdi
