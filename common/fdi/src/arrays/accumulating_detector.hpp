#pragma once

#include "quorient/fdi/array_sums.hpp"
#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// Finds faults below the noise of a single frame in an array of instruments that each measure all three directions: their body
/// vectors are compared over several windows in parallel, as weighted sums of increments (parity in the angle domain).
///
/// Over a window each instrument m gives y_m = (sum W_k theta_k) + e_m with the known cov e_m of ArraySums, which holds the noise model; an
/// instrument contradicts the others by u = R_m^-1 (y_m - y), Q = cov u, y the common rotation's estimate.
/// A hypothesis explains  T = u' Q^-1 u  of the chi-square (Q = cov u), a single axis i the part of it along the direction W b_i.
/// Hypotheses are axes, or with settings.instruments whole instruments: the more certain of all three directions and of its axes.
///
/// False alarms are bounded over all that is tried: every window gets an equal share of false_alarms_per_hour() (settings.pfa is
/// per frame; default 0.1 per hour), divided by its hypotheses and looks in an hour; all this before the state machine's confirmation. A
/// window is looked at eight times in its own length, every frame while one comes near its limit. statistic = largest
/// sqrt(T / its threshold), threshold 1.
///
/// With settings.gated_noise the windows of 8 frames or more are looked at twice, the second time as gated sums (ArraySums) that bear no
/// outliers: of the two findings the more certain one counts. Small faults in a violent motion are found sooner so.
///
/// Isolated where the best hypothesis exceeds its rivals by settings.margin (ratio of statistics, default 1.25): the second one in the most
/// certain window, and whom any other window suspects with a certainty of 0.9 or more; else ambiguous. Onset: the step is estimated over
/// that window; the onset is where a step of this size is likeliest to have begun; both are repeated until they agree. (A small error that
/// was there before does then not draw the onset into the past.)
///
/// Each frame waits for its successor (ArraySums): one frame of delay. An instrument that has lost an axis is no longer compared.
class AccumulatingDetector final : public Detector {
public:
    static constexpr std::size_t longest_window = ArraySums::longest_window;
    static constexpr std::size_t window_count = 18;

    /// Uses settings.sigma, pfa, margin, instruments, gated_noise, motion_noise (the level of usual_motion_noise).
    /// @returns why not: fewer than two instruments, an instrument that does not span space, noise or interval unknown.
    static tl::expected<std::unique_ptr<AccumulatingDetector>, std::string> make(const DetectorSettings& settings,
                                                                         const geometry::SensorCluster& cluster);
    static tl::expected<std::unique_ptr<AccumulatingDetector>, std::string> make(const DetectorSettings& settings,
                                                                         const geometry::SensorCluster& cluster, const MotionNoise& motion);

    void assess(const Measurement& measurement, Assessment& assessment) override;
    void exclude(AxisMask excluded) override;
    /// One faulty instrument, or axis, while two or more are compared.
    unsigned detectable_remaining() const override;
    void reset() override;

    double false_alarms_per_hour() const { return false_alarms_per_hour_; }
    /// An axis is near its range, or has just been: along it the newest frame proves nothing.
    bool saturated() const { return sums_.saturated() != 0; }
    /// Length of the most certain window of the newest frame, in frames.
    std::size_t window() const { return window_; }

private:
    /// Limits of T: for one axis (one degree of freedom), for an instrument (three).
    struct Limits {
        double axis = 0;
        double instrument = 0;
    };

    /// An instrument, or one axis of it.
    struct Hypothesis {
        std::size_t instrument = 0;         ///< place in the array
        std::optional<std::size_t> axis{};  ///< place in the instrument
    };

    /// What one window says.
    struct Finding {
        double certainty = 0;  ///< largest sqrt(T / threshold); above 1 is suspicious
        double second = 0;     ///< the next hypothesis's
        AxisMask best = 0;
        AxisMask runner_up = 0;
        std::size_t window = 0;
        Hypothesis hypothesis{};  ///< behind `best`

        void consider(double with_certainty, AxisMask axes, const Hypothesis& what);
    };

    AccumulatingDetector(const DetectorSettings& settings, const geometry::SensorCluster& cluster, ArraySums sums, std::optional<ArraySums> gated);

    double most_possible(std::size_t window, const Limits& limits) const;
    Finding examine(const ArraySums& sums, std::size_t window, const Limits& limits) const;
    Finding examine(std::size_t window, const Limits& limits) const;
    void weigh(std::size_t place, const ArraySums::Fit& fit, const Limits& limits, Finding& finding) const;
    Finding most_certain();
    Eigen::Vector3d step_over(std::size_t window, const Hypothesis& hypothesis) const;
    double likelihood(const Eigen::Vector3d& step, std::size_t window, const Hypothesis& hypothesis) const;
    std::size_t likeliest_window(const Eigen::Vector3d& step, const Hypothesis& hypothesis) const;
    std::uint64_t onset_of(const Finding& finding) const;
    void report(const Finding& finding, Assessment& assessment) const;

    ArraySums sums_;
    std::optional<ArraySums> gated_;
    AxisMask all_;
    bool instruments_alone_;
    double margin_;
    double false_alarms_per_hour_ = 0;
    std::array<Limits, window_count> limits_{};
    AxisMask excluded_ = 0;
    bool alert_ = false;
    std::size_t window_ = 0;
};

}  // namespace quorient::fdi
