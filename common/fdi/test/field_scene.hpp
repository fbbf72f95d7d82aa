#pragma once

#include "sensed_scene.hpp"

#include <Eigen/Geometry>
#include <span>

namespace quorient::fdi {

/// What sound instruments of one array differ by: standard deviations.
struct Differences {
    double bias_deg_s = 0.7;
    double gain = 0.008;          ///< errors of scale and cross-axis terms
    double delay_s = 0.4e-3;
    double noise_deg_s = 0.1;     ///< one sample's
    double quantum_deg_s = 0.061;
    double drift_deg_s = 0.004;   ///< random walk of the bias after one second
    double jitter_s = 0.08e-3;    ///< by which the sampling instants wander
    double own_vibration_deg_s = 0;  ///< amplitude of what each instrument feels alone, at 14 Hz
};

/// Triads on one body.
class FieldScene : public SensedScene {
public:
    FieldScene(std::size_t instruments, std::uint64_t seed, const Differences& differences = {}, double interval_s = 0.01)
        : SensedScene(seed, interval_s), differences_(differences)
    {
        cluster.axes.resize(static_cast<Eigen::Index>(3 * instruments), 3);
        for (std::size_t m = 0; m < instruments; ++m) {
            cluster.instrument_name.push_back("IMU" + std::to_string(m));
            for (int i = 0; i < 3; ++i) cluster.instrument.push_back(m);
            Instrument one;
            for (auto& value : one.bias_deg_s.reshaped()) value = differences.bias_deg_s * normal();
            for (auto& value : one.gain.reshaped()) value += differences.gain * normal();
            one.delay_s = differences.delay_s * normal();
            one.phase = any_phase();
            instruments_.push_back(one);
            mount(m, Eigen::Matrix3d::Identity());
        }
        const auto axes = static_cast<Eigen::Index>(cluster.size());
        cluster.sigma.setZero(axes);
        cluster.quantum.setZero(axes);
        cluster.range.setConstant(axes, range_deg_s * degree);
        cluster.interval_s = interval_s;
    }

    /// Rows of the rotation: the directions of the instrument's axes in the body.
    void mount(std::size_t m, const Eigen::Matrix3d& rotation)
    {
        cluster.axes.middleRows(static_cast<Eigen::Index>(3 * m), 3) = rotation;
        instruments_[m].mounted = rotation;
    }

    void set_bias(std::size_t m, std::size_t axis, double deg_s) { instruments_[m].bias_deg_s(static_cast<Eigen::Index>(axis)) = deg_s; }

private:
    struct Instrument {
        Eigen::Vector3d bias_deg_s;
        Eigen::Matrix3d gain = Eigen::Matrix3d::Identity();
        Eigen::Matrix3d mounted = Eigen::Matrix3d::Identity();
        double delay_s = 0;
        double phase = 0;
    };

    void measure(double t, Rates& rates) override
    {
        for (Instrument& one : instruments_) measure(one, t, rates);
    }

    void measure(Instrument& one, double t, Rates& rates)
    {
        const double instant = t - one.delay_s + differences_.jitter_s * normal();
        Eigen::Vector3d felt = motion(instant);
        felt += differences_.own_vibration_deg_s * std::sin(2 * std::numbers::pi * 14 * t + one.phase) * Eigen::Vector3d(1, 0.7, -0.8);
        const Eigen::Vector3d exact = one.gain * one.mounted * felt;
        for (Eigen::Index i = 0; i < 3; ++i) {
            one.bias_deg_s(i) += differences_.drift_deg_s * std::sqrt(interval_s()) * normal();
            rates.push_back(digitised(exact(i) + one.bias_deg_s(i) + differences_.noise_deg_s * normal(), differences_.quantum_deg_s));
        }
    }

    Differences differences_;
    std::vector<Instrument> instruments_;
};

/// What a detector reported while a scene was played. What it names is excluded at once, as a monitor does.
struct Played {
    AxisMask named = 0;
    std::uint64_t named_at = never;
    std::uint64_t onset = never;
    AxisMask provisional = 0;  ///< ever
    std::uint64_t provisional_at = never;
    std::uint64_t provisional_from = never;
    unsigned provisional_frames = 0;
    unsigned saturated_frames = 0;
    unsigned ambiguous_frames = 0;
    AxisMask candidates = 0;  ///< ever, where ambiguous
    AxisMask degraded = 0;    ///< ever
    std::array<AxisDiagnosis, max_axes> diagnosis{};  ///< the newest
    double largest_statistic = 0;
};

inline void listen(const Assessment& assessment, std::uint64_t sequence, Played& result)
{
    if (assessment.provisional != 0) {
        ++result.provisional_frames;
        if (result.provisional_at == never) {
            result.provisional_at = sequence;
            result.provisional_from = assessment.provisional_from;
        }
        result.provisional |= assessment.provisional;
    }
    result.saturated_frames += assessment.saturated ? 1U : 0U;
    result.degraded |= assessment.degraded;
    result.diagnosis = assessment.diagnosis;
    result.largest_statistic = std::max(result.largest_statistic, assessment.statistic);
    if (assessment.outcome == Outcome::ambiguous) {
        ++result.ambiguous_frames;
        for (std::size_t i = 0; i < assessment.candidate_count; ++i) result.candidates |= assessment.candidate[i];
    }
}

template <class Scene>
Played play(Scene& scene, Detector& detector, double seconds, AxisMask excluded = 0)
{
    Played result;
    Assessment assessment;
    const double end = scene.time_s() + seconds;
    while (scene.time_s() < end) {
        const std::uint64_t sequence = scene.sequence();
        detector.assess(scene.next(), assessment);
        listen(assessment, sequence, result);
        const AxisMask fresh = assessment.outcome == Outcome::isolated ? assessment.isolated & ~(result.named | excluded) : 0;
        if (fresh == 0) continue;
        if (result.named_at == never) {
            result.named_at = sequence;
            result.onset = assessment.onset;
        }
        result.named |= fresh;
        detector.exclude(result.named | excluded);
    }
    return result;
}

inline AxisMask axes_of(std::size_t instrument)
{
    return AxisMask{0b111} << (3 * instrument);
}

}  // namespace quorient::fdi
