#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::fdi {

/// How wrong the axes of a real array are beyond their noise at rest. Each term is a standard deviation.
struct MotionNoise {
    double jitter_along_s = 0;      ///< times |d omega/dt|: each instrument's sampling instants wander; along d omega/dt …
    double jitter_across_s = 0;     ///< … and across it; both independent from frame to frame and between instruments
    double rate_error = 0;          ///< times the angle turned through: misalignment and scale that calibration left, per axis
    double bias_floor_rad_s = 0;    ///< constant error of each axis that calibration left
    double lag_s = 0;               ///< times the change of rate over the window: constant differences of sampling instants
};

/// Finds faults below the noise of a single frame: parity in the angle domain.
///
/// For each of several windows of the last W frames the increments of every axis are summed; the sums obey z = H theta + e with
///   cov e = blockdiag over instruments m of  diag(W sigma_i^2 + floor_i^2) + H_m M H_m',
///   M     = sum over the frames of  h^2 (tau_a^2 - tau_c^2) a a' + h^2 tau_c^2 |a|^2 I,      a = d omega / dt,
///   floor = bias_floor T + rate_error * (angle turned through),
/// so that the known wildness of a violent motion is discounted in the direction in which it lies. A hypothesis (one instrument,
/// or one axis) explains  T = u' Q^-1 u  of the chi-square, with u its part of cov^-1 (z - H theta) and Q the covariance of u.
///
/// False alarms are bounded over everything that is tried: every window, hypothesis and evaluation of one hour shares
/// `false_alarms_per_hour()` (settings.pfa is per frame; default 0.1 per hour). A window is evaluated every W/8 frames, all of them in every
/// frame while one is suspicious.
///
/// Isolated where the best hypothesis exceeds the second by settings.margin (ratio of sqrt T, default 1.25) in the window that is
/// most certain; else ambiguous. The onset is the start of the window, of any length, in which the named hypothesis is likeliest.
///
/// Frames with an axis near its range (97.5 %) and the three after them are held out: they prove nothing. saturated() tells.
class Accumulating final : public Detector {
public:
    static constexpr std::size_t longest_window = 512;  ///< frames

    /// Uses settings.sigma, pfa, margin, instruments, motion. @returns why not: fewer than four axes, noise unknown.
    static tl::expected<std::unique_ptr<Accumulating>, std::string> make(const DetectorSettings& settings,
                                                                         const geometry::SensorCluster& cluster);
    static tl::expected<std::unique_ptr<Accumulating>, std::string> make(const DetectorSettings& settings,
                                                                         const geometry::SensorCluster& cluster, const MotionNoise& motion);

    void assess(const Measurement& measurement, Assessment& assessment) override;
    void exclude(AxisMask excluded) override;
    unsigned detectable_remaining() const override { return detectable_remaining_; }
    void reset() override;

    double false_alarms_per_hour() const { return false_alarms_per_hour_; }
    /// The newest frame was held out because an axis was near its range.
    bool saturated() const { return held_out_ > 0; }
    /// Frames of the window that spoke last.
    std::size_t window() const { return window_; }

private:
    static constexpr std::size_t history_length = 1024;
    static_assert(history_length > longest_window);

    /// The axes of one instrument that are in use.
    struct Block {
        std::array<Eigen::Index, max_axes> axis{};
        Eigen::Index size = 0;
    };

    /// Running totals over the frames taken in.
    struct Totals {
        geometry::AxisVector angle;  ///< of every axis
        Eigen::Matrix3d jitter = Eigen::Matrix3d::Zero();  ///< sum of h^2 a a'
        double wildness = 0;  ///< sum of h^2 |a|^2, with |a| slow to fall
        Eigen::Vector3d rate = Eigen::Vector3d::Zero();
        double time_s = 0;
        double turned_rad = 0;  ///< sum of |omega| h
        std::uint64_t sequence = 0;
    };

    /// What one window says.
    struct Finding {
        double certainty = 0;  ///< largest sqrt(T / threshold); above 1 is suspicious
        double second = 0;     ///< of the next hypothesis
        std::size_t best = 0;  ///< hypothesis
        std::size_t runner_up = 0;
        std::size_t window = 0;
    };

    Accumulating(const DetectorSettings& settings, const geometry::SensorCluster& cluster, const MotionNoise& motion);

    void form();
    bool usable(const Measurement& measurement);
    void take_in(const Measurement& measurement);
    const Totals& total(std::size_t age) const { return totals_[(next_ + history_length - 1 - age) % history_length]; }
    Finding examine(std::size_t window) const;
    Finding most_certain();
    AxisMask axes_of(std::size_t hypothesis) const;
    std::uint64_t onset_of(const Finding& finding) const;
    void report(const Finding& finding, Assessment& assessment) const;

    geometry::SensorCluster cluster_;
    geometry::AxisVector variance_;  ///< of one increment at rest
    MotionNoise motion_;
    bool instruments_;
    double margin_;
    double false_alarms_per_hour_ = 0;
    std::array<double, max_axes + 1> threshold_{};  ///< of T by degrees of freedom
    AxisMask excluded_ = 0;
    AxisMask working_ = 0;
    unsigned detectable_remaining_ = 0;
    std::vector<Block> blocks_;  ///< one per instrument, reserved once
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_axes)> least_squares_;

    std::vector<Totals> totals_;  ///< ring
    std::size_t next_ = 0;
    std::size_t size_ = 0;
    std::uint64_t frames_ = 0;
    unsigned held_out_ = 0;
    bool alert_ = false;
    std::optional<Eigen::Vector3d> previous_rate_;
    Eigen::Vector3d previous_acceleration_ = Eigen::Vector3d::Zero();
    double wildness_ = 0;
    std::size_t window_ = 0;
};

}  // namespace quorient::fdi
