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
    double noise_deg_s = 0.1;        ///< one sample's
    double quantum_deg_s = 0.061;
    double drift_deg_s = 0.004;      ///< random walk of the bias after one second
    double jitter_s = 0.08e-3;       ///< by which the sampling instants wander
    double vibration_deg_s = 12;     ///< amplitude of what all axes feel, at 17 Hz and 31 Hz
    double own_vibration_deg_s = 0.3;  ///< amplitude of what each axis feels alone, at 14 Hz
};

/// Single axes on one body, whose motion is without vibration.
class SkewedScene : public SensedScene {
public:
    SkewedScene(const std::string& layout, std::uint64_t seed, const AxisErrors& errors = {}, double interval_s = 0.01)
        : SensedScene(seed, interval_s), errors_(errors)
    {
        cluster = geometry::layout(layout).value();
        for (std::size_t i = 0; i < cluster.size(); ++i) {
            Axis one;
            const Eigen::Vector3d anywhere(normal(), normal(), normal());
            const double length = between(errors.least_row_error, errors.most_row_error);
            one.row = cluster.axes.row(static_cast<Eigen::Index>(i)).transpose() + length * anywhere.normalized();
            one.bias_deg_s = errors.bias_deg_s * normal();
            one.delay_s = errors.delay_s * normal();
            one.phase = any_phase();
            axes_.push_back(one);
        }
        cluster.range.setConstant(cluster.axes.rows(), range_deg_s * degree);
        cluster.interval_s = interval_s;
        phase_ = axes_.front().phase;
    }

    void set_bias(std::size_t axis, double deg_s) { axes_[axis].bias_deg_s = deg_s; }

private:
    struct Axis {
        Eigen::Vector3d row;
        double bias_deg_s = 0;
        double delay_s = 0;
        double phase = 0;
    };

    void measure(double t, Rates& rates) override
    {
        for (Axis& one : axes_) rates.push_back(measured(one, t));
    }

    Eigen::Vector3d vibration(double t) const
    {
        const bool rests = motion(t).isZero();
        const double size = rests ? 0 : errors_.vibration_deg_s;
        return size * (std::sin(2 * std::numbers::pi * 17 * t + phase_) * Eigen::Vector3d(1, -0.6, 0.4) +
                       std::sin(2 * std::numbers::pi * 31 * t + 2 * phase_) * Eigen::Vector3d(-0.3, 0.8, 0.7));
    }

    double measured(Axis& one, double t)
    {
        const double instant = t - one.delay_s + errors_.jitter_s * normal();
        one.bias_deg_s += errors_.drift_deg_s * std::sqrt(interval_s()) * normal();
        const double alone = motion(t).isZero() ? 0 : errors_.own_vibration_deg_s * std::sin(2 * std::numbers::pi * 14 * t + one.phase);
        const double exact = one.row.dot(motion(instant) + vibration(instant)) + alone + one.bias_deg_s;
        return digitised(exact + errors_.noise_deg_s * normal(), errors_.quantum_deg_s);
    }

    AxisErrors errors_;
    std::vector<Axis> axes_;
    double phase_ = 0;
};

}  // namespace quorient::fdi
