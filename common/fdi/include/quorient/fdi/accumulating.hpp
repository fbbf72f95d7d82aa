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

/// How wrong the axes of a real array are beyond their noise at rest. Each term is one standard deviation.
struct MotionNoise {
    double jitter_along_s = 0;    ///< times |d omega/dt|: each instrument's sampling instants wander; along d omega/dt …
    double jitter_across_s = 0;   ///< … and across it; both independent between frames and between instruments
    double roughness_s = 0;       ///< times the lately largest |d omega/dt|: outliers, which a few frames of a window dominate
    double axes_error = 0;        ///< times the rotation: misalignment and scale that calibration left; what turns back is taken back
    double rate_error = 0;        ///< times the angle turned through, whichever way: errors of another law (asymmetry, rate squared)
    double bias_floor_rad_s = 0;  ///< constant error of each axis that calibration left
};

/// What to expect of an array that was calibrated: fractions of its interval and of its own noise, as the two MIMU4444 recordings
/// show them (common/fdi/README.md has the figures). Negligible beside the noise where the motion is gentle.
MotionNoise usual_motion_noise(const geometry::SensorCluster& cluster);

/// Finds faults below the noise of a single frame in an array of instruments that each measure all three directions: their body
/// vectors are compared over several windows in parallel, as weighted sums of increments (parity in the angle domain).
///
/// Per frame k every instrument m gives theta_m = B_m z_m, with error covariance C_m (noise at rest) + M_k (motion),
///   M_k = h^2 [(tau_a^2 - tau_c^2) a a' + tau_c^2 |a|^2 I] + S_k,   a = d omega / dt,
/// the known wildness of a violent motion, which lies along a. S_k = sum (range/2)^2 b_i b_i' over the axes i near their range in this
/// frame or the one before (the sensor's filter remembers): along them nothing is known, across them the frame counts; saturated() tells.
/// Each frame is weighted by W_k = c (C + M_k)^-1, C the mean of C_m: the same for all instruments (clipping each alone would destroy
/// isolation), so that sums over a window still agree:
///   y_m = sum W_k theta_m,k = (sum W_k theta_k) + e_m,
///   cov e_m = c W + s C^-1 (C_m - C) C^-1 + floors + outliers,     W = sum W_k
///   floors: bias_floor, rate_error |omega| and axes_error omega, summed as a constant error would be;
///   outliers: kappa^2 max over the window of (|W_k| rough_k)^2, rough_k the lately largest |a| h.
/// Across a turn what little is certain then counts fully, and in the calm moments all of it.
/// A hypothesis explains  T = u' Q^-1 u  of the chi-square (Q = cov u), a single axis i the part of it along the direction W b_i.
/// Hypotheses are axes, or with settings.instruments whole instruments: the more certain of all three directions and of its axes.
///
/// False alarms are bounded over all that is tried: every window gets an equal share of false_alarms_per_hour() (settings.pfa is
/// per frame; default 0.1 per hour), divided by its hypotheses and looks in an hour; all this before the state machine's confirmation. A
/// window is looked at eight times in its own length, every frame while one comes near its limit. statistic = largest
/// sqrt(T / its threshold), threshold 1.
///
/// Isolated where the best hypothesis exceeds the second by settings.margin (ratio of statistics, default 1.25) in the most certain
/// window; else ambiguous. Onset: the step is estimated over that window; the onset is where a step of this size is likeliest to have
/// begun; both are repeated until they agree. (A small error that was there before does then not draw the onset into the past.)
///
/// Each frame waits for its successor, which tells the acceleration after it: one frame of delay. An instrument that has lost an axis is
/// no longer compared.
class Accumulating final : public Detector {
public:
    static constexpr std::size_t longest_window = 512;  ///< frames
    static constexpr std::size_t window_count = 18;
    static constexpr std::size_t max_instruments = max_axes / 3;

    /// Uses settings.sigma, pfa, margin, instruments.
    /// @returns why not: fewer than two instruments, an instrument that does not span space, noise or interval unknown.
    static tl::expected<std::unique_ptr<Accumulating>, std::string> make(const DetectorSettings& settings,
                                                                         const geometry::SensorCluster& cluster);
    static tl::expected<std::unique_ptr<Accumulating>, std::string> make(const DetectorSettings& settings,
                                                                         const geometry::SensorCluster& cluster, const MotionNoise& motion);

    void assess(const Measurement& measurement, Assessment& assessment) override;
    void exclude(AxisMask excluded) override;
    /// One faulty instrument, or axis, while two or more are compared.
    unsigned detectable_remaining() const override;
    void reset() override;

    double false_alarms_per_hour() const { return false_alarms_per_hour_; }
    /// An axis is near its range, or has just been: along it the newest frame proves nothing.
    bool saturated() const { return (near_range_ | near_range_before_) != 0; }
    /// Length of the most certain window of the newest frame, in frames.
    std::size_t window() const { return window_; }

private:
    static constexpr std::size_t history_length = 1024;
    static_assert(history_length > longest_window);

    using BodyVectors = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_instruments)>;

    struct Instrument {
        std::array<std::size_t, max_axes> axis{};
        std::size_t size = 0;
        AxisMask mask = 0;
        Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_axes)> body_from_axes;  ///< B_m
        Eigen::Matrix3d covariance;  ///< C_m, of one increment at rest
    };

    /// A frame that waits for its successor.
    struct Pending {
        std::uint64_t sequence = 0;
        double interval_s = 0;
        AxisMask saturated = 0;
        BodyVectors body{};  ///< theta_m
        Eigen::Vector3d rate = Eigen::Vector3d::Zero();
        Eigen::Vector3d acceleration_before = Eigen::Vector3d::Zero();
    };

    /// Running totals over the frames taken in; a window is the difference of two.
    struct Totals {
        BodyVectors sum{};                                 ///< W_k theta_m
        Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();  ///< W_k
        Eigen::Matrix3d biased = Eigen::Matrix3d::Zero();  ///< W_k h
        Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();  ///< W_k |omega| h
        std::array<Eigen::Matrix3d, 3> rotated{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(),
                                               Eigen::Matrix3d::Zero()};  ///< W_k omega_j h
        double rest = 0;                                                  ///< how much of W_k is that of rest, squared
        double roughness = 0;  ///< of this frame alone, weighted: |W_k|^2 times the square that roughness_s^2 multiplies
        std::uint64_t sequence = 0;
    };

    /// Of T: for one axis (one degree of freedom), for an instrument (three).
    struct Limits {
        double axis = 0;
        double instrument = 0;
    };

    /// An instrument, or one axis of it.
    struct Hypothesis {
        std::size_t instrument = 0;         ///< place in instruments_
        std::optional<std::size_t> axis{};  ///< place in the instrument
    };

    /// What one window says.
    struct Finding {
        double certainty = 0;  ///< largest sqrt(T / threshold); above 1 is suspicious
        double second = 0;     ///< of the next hypothesis
        AxisMask best = 0;
        AxisMask runner_up = 0;
        std::size_t window = 0;
        Hypothesis hypothesis{};  ///< behind `best`

        void consider(double with_certainty, AxisMask axes, const Hypothesis& what);
    };

    /// What one instrument contradicts the others by.
    struct Contradiction {
        Eigen::Vector3d u;  ///< R_m^-1 (y_m - y)
        Eigen::Matrix3d q;  ///< cov u
    };

    /// The fit of one window: all instruments' common rotation.
    struct Fit {
        std::array<Eigen::Matrix3d, max_instruments> information;  ///< R_m^-1
        std::array<Eigen::Vector3d, max_instruments> value;        ///< y_m
        Eigen::Matrix3d weight;                                    ///< W
        Eigen::Matrix3d covariance;                                ///< of y
        Eigen::Vector3d fused;                                     ///< y

        Contradiction contradiction(std::size_t instrument) const;
    };

    Accumulating(const DetectorSettings& settings, const geometry::SensorCluster& cluster, const MotionNoise& motion);

    std::string form_instruments();
    bool compared(const Instrument& instrument) const { return (instrument.mask & excluded_) == 0; }
    bool usable(const Measurement& measurement);
    Pending pending_of(const Measurement& measurement) const;
    void take_in(const Pending& frame, const Eigen::Vector3d& acceleration_after);
    Eigen::Matrix3d blindness(AxisMask saturated, double interval_s) const;
    Eigen::Matrix3d motion_covariance(const Pending& frame, const Eigen::Vector3d& acceleration_after, double blow, double rough) const;
    const Totals& total(std::size_t age) const { return totals_[(next_ + history_length - 1 - age) % history_length]; }

    Eigen::Matrix3d common_covariance(std::size_t window) const;
    Fit fit(std::size_t window) const;
    Finding examine(std::size_t window, const Limits& limits) const;
    void weigh(std::size_t place, const Fit& fit, const Limits& limits, Finding& finding) const;
    Finding most_certain();
    Eigen::Vector3d step_over(std::size_t window, const Hypothesis& hypothesis) const;
    double likelihood(const Eigen::Vector3d& step, std::size_t window, const Hypothesis& hypothesis) const;
    std::size_t likeliest_window(const Eigen::Vector3d& step, const Hypothesis& hypothesis) const;
    std::uint64_t onset_of(const Finding& finding) const;
    void report(const Finding& finding, Assessment& assessment) const;

    geometry::SensorCluster cluster_;
    geometry::AxisVector variance_;  ///< of one increment at rest
    MotionNoise motion_;
    bool instruments_alone_;
    double margin_;
    double false_alarms_per_hour_ = 0;
    std::array<Limits, window_count> limits_{};
    AxisMask excluded_ = 0;
    std::vector<Instrument> instruments_;
    Eigen::Matrix3d mean_covariance_;   ///< C
    Eigen::Matrix3d mean_information_;  ///< C^-1
    double scale_ = 0;                  ///< c: W_k has trace 3 at rest

    std::vector<Totals> totals_;  ///< ring
    std::size_t next_ = 0;
    std::size_t size_ = 0;
    std::uint64_t frames_ = 0;
    AxisMask near_range_ = 0;         ///< axes near their range in the newest frame …
    AxisMask near_range_before_ = 0;  ///< … and in the one before
    bool alert_ = false;
    std::optional<Pending> pending_;
    double wildness_ = 0;  ///< |d omega/dt|^2, slow to fall
    std::size_t window_ = 0;
};

}  // namespace quorient::fdi
