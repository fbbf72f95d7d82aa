#include "single_frame/guaranteed_detector.hpp"

#include "test_clusters.hpp"

#include <gtest/gtest.h>
#include <cmath>

namespace quorient::fdi {
namespace {

DetectorSettings with_bound(double bound, std::optional<double> threshold = {}, unsigned max_faults = 2)
{
    DetectorSettings settings;
    settings.bound = bound;
    settings.threshold = threshold;
    settings.max_faults = max_faults;
    return settings;
}

struct Trial {
    std::vector<double> error;  ///< rho
    std::vector<double> z;
    AxisMask faulty = 0;
};

/// Noise inside the bound 1, on its very corners in every third trial; faults of any size.
Trial random_trial(const geometry::SensorCluster& cluster, std::size_t faults, Random& random)
{
    Trial trial;
    trial.faulty = random.axes(faults, cluster.size());
    trial.z = measure(cluster, random.body(1000));
    const bool corner = random.below(3) == 0;
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        double error = corner ? random.sign() : random.uniform(-1, 1);
        if (has_axis(trial.faulty, axis)) error = random.sign() * std::exp(random.uniform(-1, 6));
        trial.error.push_back(error);
        trial.z[axis] += error;
    }
    return trial;
}

void expect_sound(const geometry::SensorCluster& cluster, unsigned max_faults, std::uint64_t seed, int trials)
{
    Random random(seed);
    const auto detector = GuaranteedDetector::make(with_bound(1, 10, max_faults), cluster).value();
    int seen = 0;
    for (int k = 0; k < trials; ++k) {
        const Trial trial = random_trial(cluster, random.below(max_faults + 1), random);
        const auto assessment = assess(*detector, trial.z);
        ASSERT_NE(assessment.outcome, Outcome::blind) << "seed " << seed << ", trial " << k;
        for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
            const double rounding = 1e-9 * (1 + std::abs(trial.z[axis]));
            ASSERT_LE(std::abs(assessment.residual[axis] - trial.error[axis]), assessment.bound[axis] + rounding)
                << "seed " << seed << ", trial " << k << ", axis " << axis;
            if (detector->decision(axis) != 'F') continue;
            ASSERT_TRUE(has_axis(trial.faulty, axis))
                << "seed " << seed << ", trial " << k << ": healthy axis " << axis << " called faulty";
        }
        if (assessment.outcome != Outcome::healthy) ++seen;
    }
    EXPECT_GT(seen, trials / 10) << "the faults were hardly ever seen";
}

TEST(Guaranteed, holds_the_true_error_and_never_calls_a_healthy_axis_faulty)
{
    expect_sound(cluster_named("guaranteed-cone"), 2, 1, 20'000);
    expect_sound(cluster_named("dodecahedron"), 2, 2, 20'000);
}

TEST(Guaranteed, is_sound_on_other_numbers_of_axes)
{
    expect_sound(cluster_named("cone-5"), 1, 3, 5'000);
    expect_sound(cluster_named("dodecahedron"), 1, 4, 5'000);
    expect_sound(cluster_named("cone-7"), 2, 5, 5'000);
    expect_sound(cluster_named("octahedron-8"), 2, 6, 5'000);
}

TEST(Guaranteed, is_sound_where_some_axes_left_span_no_space)
{
    expect_sound(cluster_named("triads-2"), 1, 7, 5'000);
}

TEST(Guaranteed, names_both_faults_of_the_papers_example)
{
    const auto detector = GuaranteedDetector::make(with_bound(1, 10), cluster_named("guaranteed-cone")).value();
    const auto assessment = assess(*detector, {-393.04, 1075.35, -612.73, -593.11, 1254.79, -761.19});
    EXPECT_EQ(assessment.outcome, Outcome::isolated);
    EXPECT_EQ(assessment.isolated, axis_bit(1) | axis_bit(2));
    EXPECT_EQ(detector->feasible_count(), 1U);
    EXPECT_NEAR(assessment.residual[1], 20.8925, 1e-9);
    EXPECT_NEAR(assessment.bound[2], 2.7375, 1e-9);
}

TEST(Guaranteed, finds_no_explanation_for_the_example_as_printed)
{
    const auto detector = GuaranteedDetector::make(with_bound(1, 10), cluster_named("guaranteed-cone")).value();
    const auto assessment = assess(*detector, {-393.04, 1085.35, -612.73, -593.11, 1254.79, 761.19});
    EXPECT_EQ(assessment.outcome, Outcome::blind);
    EXPECT_TRUE(detector->empty());
}

TEST(Guaranteed, finds_the_least_threshold_that_leaves_no_healthy_frame_undecided)
{
    const double cone = GuaranteedDetector::make(with_bound(1), cluster_named("guaranteed-cone")).value()->threshold();
    const double dodecahedron = GuaranteedDetector::make(with_bound(1), cluster_named("dodecahedron")).value()->threshold();
    EXPECT_NEAR(cone, 7, 1e-6);
    EXPECT_NEAR(dodecahedron, 1 + 2 * std::sqrt(5.0), 1e-6);
}

/// All corners of the error box: 64 frames of six axes.
std::size_t undecided_corners(const geometry::SensorCluster& cluster, Detector& detector)
{
    std::size_t undecided = 0;
    for (AxisMask corner = 0; corner < 64; ++corner) {
        std::vector<double> z = measure(cluster, {100, -20, 3});
        for (std::size_t axis = 0; axis < 6; ++axis) z[axis] += has_axis(corner, axis) ? 1 : -1;
        if (assess(detector, z).outcome != Outcome::healthy) ++undecided;
    }
    return undecided;
}

TEST(Guaranteed, is_healthy_on_every_corner_of_the_noise_at_its_own_threshold_and_not_below)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto own = GuaranteedDetector::make(with_bound(1), cluster).value();
    const auto tight = GuaranteedDetector::make(with_bound(1, own->threshold() * 0.99), cluster).value();
    EXPECT_EQ(undecided_corners(cluster, *own), 0U);
    EXPECT_GT(undecided_corners(cluster, *tight), 0U);
}

TEST(Guaranteed, is_blind_to_none_but_three_large_faults)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = GuaranteedDetector::make(with_bound(1, 10), cluster).value();
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{0, 50}, {1, 90}})).outcome, Outcome::isolated);
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{0, 50}, {1, 90}, {4, 170}})).outcome, Outcome::blind);
}

TEST(Guaranteed, lists_the_sets_where_a_fault_can_be_explained_in_several_ways)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = GuaranteedDetector::make(with_bound(1, 10), cluster).value();
    Random random(8);
    int ambiguous = 0;
    for (int k = 0; k < 2000; ++k) {
        const Trial trial = random_trial(cluster, 2, random);
        const auto assessment = assess(*detector, trial.z);
        if (assessment.outcome != Outcome::ambiguous) continue;
        ++ambiguous;
        bool truth_listed = assessment.candidates_truncated;
        for (std::size_t c = 0; c < assessment.candidate_count; ++c)
            truth_listed |= (assessment.candidate[c] & trial.faulty) == trial.faulty;
        EXPECT_TRUE(truth_listed) << "seed " << random.seed() << ", trial " << k;
    }
    EXPECT_GT(ambiguous, 0);
}

TEST(Guaranteed, goes_on_with_fewer_assumed_faults_after_exclusions)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = GuaranteedDetector::make(with_bound(1, 10), cluster).value();
    detector->exclude(axis_bit(0));
    const auto second = assess(*detector, measure(cluster, {1, 2, 3}, {{0, 1e9}, {3, 60}}));
    EXPECT_EQ(second.outcome, Outcome::isolated);
    EXPECT_EQ(second.isolated, axis_bit(3));

    detector->exclude(axis_bit(0) | axis_bit(3));
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{0, 1e9}, {3, 60}})).outcome, Outcome::healthy);
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{0, 1e9}, {3, 60}, {4, 60}})).outcome, Outcome::blind);
}

TEST(Guaranteed, has_no_interval_where_the_axes_left_do_not_reach)
{
    // Without both x axes of two aligned triads nothing determines the x component; without one, the other bounds it.
    const auto detector = GuaranteedDetector::make(with_bound(1, 10), cluster_named("triads-2")).value();
    assess(*detector, measure(cluster_named("triads-2"), {1, 2, 3}));
    std::size_t both_x = 0;
    while (detector->set(both_x) != (axis_bit(0) | axis_bit(3))) ++both_x;
    EXPECT_EQ(detector->interval_of(both_x, {1, 0, 0}).upper, INFINITY);
    EXPECT_NEAR(detector->interval_of(both_x, {0, 1, 0}).upper, 3, 1e-12);
    EXPECT_NEAR(detector->interval_of(0, {1, 0, 0}).upper, 2, 1e-12);
}

TEST(Guaranteed, refuses_what_it_cannot_serve_and_says_why)
{
    const auto refusal = [](const DetectorSettings& settings, const std::string& layout) {
        const auto made = GuaranteedDetector::make(settings, cluster_named(layout));
        return made ? std::string() : made.error();
    };
    EXPECT_NE(refusal(with_bound(1, 10, 2), "cone-5").find("6 to 8 axes"), std::string::npos);
    EXPECT_NE(refusal(with_bound(1, 10, 2), "triads-3").find("6 to 8 axes"), std::string::npos);
    EXPECT_NE(refusal(with_bound(1, 10, 3), "octahedron-8").find("max_faults 1 or 2"), std::string::npos);
    EXPECT_NE(refusal(with_bound(NAN, 10), "dodecahedron").find("bound"), std::string::npos);
    EXPECT_NE(refusal(with_bound(0, 10), "dodecahedron").find("bound"), std::string::npos);
    EXPECT_NE(refusal(with_bound(1, NAN), "dodecahedron").find("threshold"), std::string::npos);
    EXPECT_NE(refusal(with_bound(1), "triads-2").find("lower max_faults, or set threshold"), std::string::npos);
    EXPECT_NE(refusal({}, "dodecahedron").find("set bound"), std::string::npos);
    EXPECT_EQ(refusal(with_bound(1, 10), "dodecahedron"), "");
}

}  // namespace
}  // namespace quorient::fdi
