#pragma once

#include "field_scene.hpp"
#include "quorient/geometry/layouts.hpp"

#include <string>

namespace quorient::fdi {

/// What sound axes of a vibrating, uncalibrated block differ by.
struct AxisErrors {
    double bias_deg_s = 0.7;         ///< standard deviation
    double least_row_error = 0.01;   ///< length of the error of scale and direction, even between these two
    double most_row_error = 0.03;
    double delay_s = 0.4e-3;         ///< standard deviation
    double noise_deg_s = 0.1;        ///< of one sample
    double quantum_deg_s = 0.061;
    double drift_deg_s = 0.004;      ///< random walk of the bias after one second
    double jitter_s = 0.08e-3;       ///< of the sampling instants
    double vibration_deg_s = 12;     ///< amplitude of what all axes feel, at 17 Hz and 31 Hz
    double own_vibration_deg_s = 0.3;  ///< amplitude of what each axis feels alone, at 14 Hz
};

/// Single axes on one body. The truth is known: their errors, the motion, and what a test spoils.
class SkewedScene {
public:
    using Rates = FieldScene::Rates;

    SkewedScene(const std::string& layout, std::uint64_t seed, const AxisErrors& errors = {}, double interval_s = 0.01)
        : cluster(geometry::layout(layout).value()), interval_s_(interval_s), errors_(errors), random_(seed)
    {
        for (std::size_t i = 0; i < cluster.size(); ++i) {
            Axis one;
            const Eigen::Vector3d anywhere(normal(), normal(), normal());
            const double length = std::uniform_real_distribution<double>(errors.least_row_error, errors.most_row_error)(random_);
            one.row = cluster.axes.row(static_cast<Eigen::Index>(i)).transpose() + length * anywhere.normalized();
            one.bias_deg_s = errors.bias_deg_s * normal();
            one.delay_s = errors.delay_s * normal();
            one.phase = 2 * std::numbers::pi * std::uniform_real_distribution<double>()(random_);
            axes_.push_back(one);
        }
        cluster.range.setConstant(cluster.axes.rows(), FieldScene::range_deg_s * degree);
        cluster.interval_s = interval_s;
        phase_ = axes_.front().phase;
    }

    void set_bias(std::size_t axis, double deg_s) { axes_[axis].bias_deg_s = deg_s; }

    std::function<Eigen::Vector3d(double)> motion = FieldScene::flight_after(2);  ///< of the body, without vibration [deg/s]
    std::function<void(std::uint64_t sequence, Rates&)> spoil = [](std::uint64_t, Rates&) {};

    /// The next measurement; NaN where an axis has no data.
    Measurement next()
    {
        const double t = static_cast<double>(sequence_) * interval_s_;
        rates_.clear();
        for (Axis& one : axes_) rates_.push_back(measure(one, t));
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

    geometry::SensorCluster cluster;

private:
    struct Axis {
        Eigen::Vector3d row;
        double bias_deg_s = 0;
        double delay_s = 0;
        double phase = 0;
    };

    Eigen::Vector3d vibration(double t) const
    {
        const bool rests = motion(t).isZero();
        const double size = rests ? 0 : errors_.vibration_deg_s;
        return size * (std::sin(2 * std::numbers::pi * 17 * t + phase_) * Eigen::Vector3d(1, -0.6, 0.4) +
                       std::sin(2 * std::numbers::pi * 31 * t + 2 * phase_) * Eigen::Vector3d(-0.3, 0.8, 0.7));
    }

    double measure(Axis& one, double t)
    {
        const double instant = t - one.delay_s + errors_.jitter_s * normal();
        one.bias_deg_s += errors_.drift_deg_s * std::sqrt(interval_s_) * normal();
        const double alone = motion(t).isZero() ? 0 : errors_.own_vibration_deg_s * std::sin(2 * std::numbers::pi * 14 * t + one.phase);
        double value = one.row.dot(motion(instant) + vibration(instant)) + alone + one.bias_deg_s + errors_.noise_deg_s * normal();
        if (errors_.quantum_deg_s > 0) value = std::round(value / errors_.quantum_deg_s) * errors_.quantum_deg_s;
        return std::clamp(value, -FieldScene::range_deg_s, FieldScene::range_deg_s);
    }

    double interval_s_;
    AxisErrors errors_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    std::vector<Axis> axes_;
    double phase_ = 0;
    Rates rates_;
    std::vector<double> increments_;
    std::uint64_t sequence_ = 0;
};

}  // namespace quorient::fdi
