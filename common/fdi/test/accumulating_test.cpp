#include "arrays/accumulating_detector.hpp"

#include "field/field_detector.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/fdi/methods.hpp"
#include "quorient/geometry/layouts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <span>
#include <string>

namespace quorient::fdi {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr double interval_s = 0.016;
constexpr double rate_sigma = 0.25 * degree;  // one axis's, as the MIMU4444's
constexpr double range_rad_s = 2000 * degree;

/// A real array as its recordings show it: noise at rest, and each instrument samples at an instant of its own that wanders.
class Array {
public:
    explicit Array(std::uint64_t seed, const char* layout = "triads-3") : cluster(geometry::layout(layout).value()), random_(seed)
    {
        cluster.sigma.setConstant(rate_sigma * interval_s);
        cluster.quantum.setZero();
        cluster.range.setConstant(range_rad_s);
        cluster.interval_s = interval_s;
    }

    static Eigen::Vector3d rest(double) { return Eigen::Vector3d::Zero(); }

    /// About 500 deg/s and 10 000 deg/s^2.
    static Eigen::Vector3d violent(double t)
    {
        return {8 * std::sin(21 * t), 7 * std::sin(17 * t + 1) + 3 * std::sin(5 * t), 8 * std::cos(19 * t)};
    }

    template <class Motion>
    SensorFrame frame(std::uint64_t sequence, Motion motion)
    {
        std::normal_distribution<double> normal;
        SensorFrame made;
        made.epoch = 1;
        made.sequence = sequence;
        made.interval_s = interval_s;
        made.axis_count = static_cast<std::uint8_t>(cluster.size());
        made.valid_mask = cluster.all();
        const double t = static_cast<double>(sequence) * interval_s;
        Eigen::Vector3d rate = Eigen::Vector3d::Zero();
        for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
            if (axis % 3 == 0) rate = motion(t + instant_s() + jitter_s * normal(random_));
            const double measured = cluster.axes.row(static_cast<Eigen::Index>(axis)).dot(rate) + rate_sigma * normal(random_);
            made.increment[axis] = measured * interval_s;
        }
        return made;
    }

    double jitter_s = 0.1e-3;
    double outlier_s = 0;  ///< once in a hundred frames an instrument samples this late
    geometry::SensorCluster cluster;

private:
    double instant_s()
    {
        if (outlier_s == 0) return 0;
        return std::bernoulli_distribution(0.01)(random_) ? outlier_s : 0;
    }

    std::mt19937_64 random_;
};

Assessment assess(AccumulatingDetector& detector, const SensorFrame& frame)
{
    Assessment assessment;
    detector.assess({.identity = identity_of(frame),
                     .interval_s = frame.interval_s,
                     .increment = std::span(frame.increment).first(frame.axis_count),
                     .valid = frame.valid_mask},
                    assessment);
    return assessment;
}

struct Outcomes {
    AxisMask isolated = 0;
    std::uint64_t isolated_at = never;
    std::uint64_t excluded_from = never;
};

template <class Motion>
Outcomes play(std::uint64_t seed, bool instruments, Motion motion, double bias_deg_s, std::size_t axis, std::uint64_t from,
              std::uint64_t frames)
{
    Array array(seed);
    DetectorSettings settings{.method = "accumulating"};
    settings.instruments = instruments;
    auto monitor = FaultMonitor::make(settings, {}, array.cluster).value();
    Outcomes outcomes;
    for (std::uint64_t sequence = 0; sequence < frames; ++sequence) {
        SensorFrame frame = array.frame(sequence, motion);
        if (sequence >= from) frame.increment[axis] += bias_deg_s * degree * interval_s;
        const FaultVerdict& verdict = monitor.assess(frame);
        if (verdict.isolated_mask == 0) continue;
        outcomes = {.isolated = verdict.isolated_mask, .isolated_at = sequence, .excluded_from = verdict.excluded_from[axis]};
        break;
    }
    return outcomes;
}

TEST(Accumulating, finds_at_rest_what_no_single_frame_shows_and_names_the_axis)
{
    for (std::size_t axis = 0; axis < 9; ++axis) {
        SCOPED_TRACE("axis " + std::to_string(axis));
        const Outcomes outcomes = play(100 + axis, false, Array::rest, 0.5, axis, 600, 1200);  // two standard deviations of one frame
        EXPECT_EQ(outcomes.isolated, axis_bit(axis));
        EXPECT_GE(outcomes.isolated_at, 600U);
        EXPECT_LE(outcomes.isolated_at, 600U + 62) << "later than 1 s";
        EXPECT_LE(outcomes.excluded_from, 600U + 10);
    }
}

TEST(Accumulating, finds_a_large_fault_in_three_frames)
{
    const Outcomes outcomes = play(7, true, Array::rest, 20, 4, 600, 700);
    EXPECT_EQ(outcomes.isolated, 0b000111000U);
    EXPECT_LE(outcomes.isolated_at, 602U);
    EXPECT_LE(outcomes.excluded_from, 600U);
}

TEST(Accumulating, finds_a_fault_in_a_violent_motion_and_names_the_instrument)
{
    for (std::size_t axis = 0; axis < 9; ++axis) {
        SCOPED_TRACE("axis " + std::to_string(axis));
        const Outcomes outcomes = play(200 + axis, true, Array::violent, 10, axis, 600, 1200);
        EXPECT_EQ(outcomes.isolated, AxisMask{0b111} << (axis / 3 * 3));
        EXPECT_GE(outcomes.isolated_at, 600U);
        EXPECT_LE(outcomes.isolated_at, 600U + 94) << "later than 1.5 s";
    }
}

TEST(Accumulating, is_silent_without_a_fault_at_rest_and_in_violent_motion)
{
    EXPECT_EQ(play(31, true, Array::rest, 0, 0, 0, 40'000).isolated, 0U);
    EXPECT_EQ(play(32, false, Array::rest, 0, 0, 0, 40'000).isolated, 0U);
    EXPECT_EQ(play(33, true, Array::violent, 0, 0, 0, 40'000).isolated, 0U);
    EXPECT_EQ(play(34, false, Array::violent, 0, 0, 0, 40'000).isolated, 0U);
}

/// A body that turns faster than the range about z: every instrument's third axis shows its own limit.
std::uint64_t isolated_beyond_the_range(double bias_deg_s)
{
    Array array(11);
    auto monitor = FaultMonitor::make({.method = "accumulating"}, {}, array.cluster).value();
    for (std::uint64_t sequence = 0; sequence < 1200; ++sequence) {
        SensorFrame frame = array.frame(sequence, Array::rest);
        for (const std::size_t axis : {2U, 5U, 8U})
            frame.increment[axis] = (0.985 + 0.002 * static_cast<double>(axis)) * range_rad_s * interval_s;
        if (sequence >= 600) frame.increment[3] += bias_deg_s * degree * interval_s;
        const FaultVerdict& verdict = monitor.assess(frame);
        if (verdict.isolated_mask == 0) continue;
        EXPECT_EQ(verdict.isolated_mask, axis_bit(3));
        return sequence;
    }
    return never;
}

TEST(Accumulating, finds_a_fault_across_the_direction_in_which_the_others_are_saturated)
{
    // While the body turns at 2000 deg/s, an error of its axes of a thousandth looks like a bias of 2 deg/s.
    const std::uint64_t isolated_at = isolated_beyond_the_range(15);
    EXPECT_GE(isolated_at, 600U);
    EXPECT_LE(isolated_at, 605U);
    EXPECT_EQ(isolated_beyond_the_range(0), never) << "their limits differ by 24 deg/s: that is no fault";
}

TEST(Accumulating, dates_a_step_by_its_own_size_whatever_small_error_was_there_before)
{
    for (std::uint64_t seed = 40; seed < 46; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Array array(seed);
        auto monitor = FaultMonitor::make({.method = "accumulating"}, {}, array.cluster).value();
        std::uint64_t excluded_from = never;
        for (std::uint64_t sequence = 0; sequence < 1200 && excluded_from == never; ++sequence) {
            SensorFrame frame = array.frame(sequence, Array::rest);
            frame.increment[4] += (sequence < 700 ? 0.1 : 1.0) * degree * interval_s;
            excluded_from = monitor.assess(frame).excluded_from[4];
        }
        EXPECT_GE(excluded_from, 694U);
        EXPECT_LE(excluded_from, 703U);
    }
}

TEST(Accumulating, does_not_blame_an_axis_that_alone_is_near_its_range)
{
    Array array(5);
    auto detector = AccumulatingDetector::make({}, array.cluster).value();
    Assessment assessment;
    for (std::uint64_t sequence = 0; sequence < 500; ++sequence) {
        SensorFrame frame = array.frame(sequence, Array::rest);
        const bool saturated = sequence >= 200 && sequence < 230;
        if (saturated) frame.increment[3] = range_rad_s * interval_s;
        assessment = assess(*detector, frame);
        EXPECT_EQ(detector->saturated(), sequence >= 200 && sequence <= 230) << "frame " << sequence;
        EXPECT_NE(assessment.outcome, Outcome::isolated);
    }
}

/// Instruments of unlike noise in a turn whose acceleration hides one direction: the largest statistic, and who is isolated.
struct Unlike {
    double largest = 0;
    AxisMask isolated = 0;
};

Unlike play_unlike(std::uint64_t seed, double bias_deg_s, std::size_t axis)
{
    constexpr double rate_sigma_of_others = 1 * degree;
    Array array(seed);
    array.jitter_s = 0.6e-3;
    for (Eigen::Index other = 3; other < 9; ++other) array.cluster.sigma(other) = std::hypot(rate_sigma, rate_sigma_of_others) * interval_s;
    const auto turning = [](double t) { return Eigen::Vector3d(3 * std::sin(9 * t), 2 * std::sin(8 * t + 1), 3 * std::cos(10 * t)); };
    DetectorSettings settings{.method = "accumulating"};
    settings.instruments = true;
    const auto detector = AccumulatingDetector::make(settings, array.cluster, {.jitter_along_s = array.jitter_s}).value();
    std::mt19937_64 random(seed + 1000);
    std::normal_distribution<double> normal;
    Assessment assessment;
    Unlike result;
    for (std::uint64_t sequence = 0; sequence < 4000 && result.isolated == 0; ++sequence) {
        SensorFrame frame = array.frame(sequence, turning);
        for (std::size_t other = 3; other < 9; ++other) frame.increment[other] += rate_sigma_of_others * interval_s * normal(random);
        frame.increment[axis] += bias_deg_s * degree * interval_s;
        assessment = assess(*detector, frame);
        result.largest = std::max(result.largest, assessment.statistic);
        result.isolated = assessment.isolated;
    }
    return result;
}

TEST(Accumulating, is_silent_where_a_turn_hides_one_direction_of_instruments_of_unlike_noise)
{
    for (std::uint64_t seed = 1; seed <= 5; ++seed) EXPECT_LT(play_unlike(seed, 0, 0).largest, 1) << "seed " << seed;
}

TEST(Accumulating, names_who_is_wrong_where_a_turn_hides_one_direction_of_instruments_of_unlike_noise)
{
    for (std::size_t axis = 0; axis < 9; ++axis) {
        const AxisMask instrument = AxisMask{7} << (axis / 3 * 3);
        EXPECT_EQ(play_unlike(axis, 3, axis).isolated, instrument) << "axis " << axis;
    }
}

/// The newest assessment of an array at rest, whose instruments `wrong` have had 20 deg/s too much on their first axes for a hundred
/// frames.
Assessment assessment_of(const char* layout, std::initializer_list<std::size_t> wrong)
{
    Array array(9, layout);
    DetectorSettings settings;
    settings.instruments = true;
    const auto detector = AccumulatingDetector::make(settings, array.cluster).value();
    Assessment assessment;
    for (std::uint64_t sequence = 0; sequence <= 300; ++sequence) {
        SensorFrame frame = array.frame(sequence, Array::rest);
        for (const std::size_t instrument : wrong)
            if (sequence > 200) frame.increment[3 * instrument] += 20 * degree * interval_s;
        assessment = assess(*detector, frame);
        EXPECT_NE(assessment.outcome, Outcome::isolated) << "frame " << sequence;
    }
    return assessment;
}

TEST(Accumulating, is_ambiguous_between_two_instruments)
{
    const Assessment assessment = assessment_of("triads-2", {0});
    EXPECT_EQ(assessment.outcome, Outcome::ambiguous);
    EXPECT_EQ(assessment.candidate_count, 2);
}

TEST(Accumulating, names_nobody_where_two_instruments_are_wrong_alike)
{
    EXPECT_EQ(assessment_of("triads-4", {0, 1}).outcome, Outcome::ambiguous);
}

TEST(Accumulating, says_how_much_is_left_to_detect)
{
    auto detector = AccumulatingDetector::make({}, Array(1).cluster).value();
    EXPECT_EQ(detector->detectable_remaining(), 1U);
    detector->exclude(0b000000111);
    EXPECT_EQ(detector->detectable_remaining(), 1U);
    detector->exclude(0b000001111);
    EXPECT_EQ(detector->detectable_remaining(), 0U) << "one whole instrument has nothing to be compared with";
}

TEST(Auto, takes_the_field_detector_on_three_triads_and_not_on_two_nor_for_two_faults)
{
    const auto taken = [](const DetectorSettings& settings, const char* layout) {
        const auto made = make_detector(settings, Array(1, layout).cluster).value();
        return dynamic_cast<const FieldDetector*>(made.get()) != nullptr;
    };
    DetectorSettings settings;
    EXPECT_TRUE(taken(settings, "triads-3"));
    EXPECT_TRUE(taken(settings, "triads-8"));
    EXPECT_FALSE(taken(settings, "triads-2"));
    settings.max_faults = 2;
    EXPECT_FALSE(taken(settings, "triads-3"));
}

/// Whether an array that jitters ten times as much is blamed in violent motion, and when it has a fault of 60 deg/s from frame 5000 on.
AxisMask blamed_of_a_wild_array(std::optional<double> motion_noise, double bias_deg_s)
{
    Array array(35);
    array.jitter_s = 1e-3;
    DetectorSettings settings{.method = "accumulating", .motion_noise = motion_noise};
    settings.instruments = true;
    auto monitor = FaultMonitor::make(settings, {}, array.cluster).value();
    for (std::uint64_t sequence = 0; sequence < 6000; ++sequence) {
        SensorFrame frame = array.frame(sequence, Array::violent);
        if (sequence >= 5000) frame.increment[4] += bias_deg_s * degree * interval_s;
        if (const AxisMask isolated = monitor.assess(frame).isolated_mask; isolated != 0) return isolated;
    }
    return 0;
}

TEST(Accumulating, expects_as_much_of_the_motion_as_it_is_told)
{
    EXPECT_NE(blamed_of_a_wild_array(std::nullopt, 0), 0U) << "the usual noise is too little here";
    EXPECT_EQ(blamed_of_a_wild_array(8, 0), 0U);
    EXPECT_EQ(blamed_of_a_wild_array(8, 60), 0b000111000U);
}

constexpr MotionNoise mostly_calm{.jitter_along_s = 0.12e-3, .jitter_across_s = 0.05e-3};

/// Frames from the onset of a fault in violent motion, with outliers of 2.5 ms, until its instrument is isolated; `never` if it is not.
std::uint64_t found_among_outliers(std::uint64_t seed, std::optional<MotionNoise> gated_noise, double bias_deg_s, std::uint64_t frames)
{
    constexpr std::uint64_t onset = 600;
    Array array(seed);
    array.outlier_s = 2.5e-3;
    DetectorSettings settings{.method = "accumulating", .gated_noise = gated_noise};
    settings.instruments = true;
    auto monitor = FaultMonitor::make(settings, {}, array.cluster).value();
    for (std::uint64_t sequence = 0; sequence < onset + frames; ++sequence) {
        SensorFrame frame = array.frame(sequence, Array::violent);
        if (sequence >= onset) frame.increment[4] += bias_deg_s * degree * interval_s;
        const AxisMask isolated = monitor.assess(frame).isolated_mask;
        if (isolated == 0) continue;
        EXPECT_EQ(isolated, 0b000111000U) << "seed " << seed;
        return sequence - onset;
    }
    return never;
}

TEST(Accumulating, finds_small_faults_among_outliers_sooner_with_gated_sums)
{
    for (std::uint64_t seed = 60; seed < 66; ++seed) {
        const std::uint64_t without = found_among_outliers(seed, std::nullopt, 5, 2000);
        const std::uint64_t with = found_among_outliers(seed, mostly_calm, 5, 2000);
        EXPECT_LE(with, 125U) << "seed " << seed << ": later than 2 s";
        EXPECT_LE(2 * with, without) << "seed " << seed;
    }
}

TEST(Accumulating, is_silent_among_outliers_with_gated_sums)
{
    EXPECT_EQ(found_among_outliers(66, mostly_calm, 0, 40'000), never);
}

TEST(Accumulating, refuses_what_it_cannot_serve_and_says_why)
{
    const auto refusal = [](const DetectorSettings& settings, const geometry::SensorCluster& cluster) {
        const auto made = AccumulatingDetector::make(settings, cluster);
        return made ? std::string{} : made.error();
    };
    auto cluster = Array(1).cluster;
    EXPECT_EQ(refusal({}, cluster), "");
    EXPECT_THAT(refusal({}, Array(1, "cone-6").cluster), ::testing::HasSubstr("all three directions"));
    cluster.interval_s = 0;
    EXPECT_THAT(refusal({}, cluster), ::testing::HasSubstr("interval_s"));
    cluster = Array(1).cluster;
    cluster.sigma.setZero();
    EXPECT_THAT(refusal({}, cluster), ::testing::HasSubstr("sigma"));
    EXPECT_FALSE(AccumulatingDetector::make({}, Array(1).cluster, {.jitter_along_s = -1}));
    EXPECT_FALSE(AccumulatingDetector::make({.gated_noise = MotionNoise{.axes_error = -1}}, Array(1).cluster));
    EXPECT_THAT(refusal({.motion_noise = -1}, cluster), ::testing::HasSubstr("motion_noise"));
}

TEST(Accumulating, states_its_false_alarms_per_hour)
{
    EXPECT_DOUBLE_EQ(AccumulatingDetector::make({}, Array(1).cluster).value()->false_alarms_per_hour(), 0.1);
    EXPECT_DOUBLE_EQ(AccumulatingDetector::make({.pfa = 1e-6}, Array(1).cluster).value()->false_alarms_per_hour(), 1e-6 * 3600 / interval_s);
}

}  // namespace
}  // namespace quorient::fdi
