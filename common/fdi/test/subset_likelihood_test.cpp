#include "single_frame/subset_detector.hpp"

#include "test_clusters.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>
#include <cmath>

namespace quorient::fdi {
namespace {

DetectorSettings with(double margin, unsigned max_faults = 2)
{
    DetectorSettings settings;
    settings.sigma = 1;
    settings.pfa = 1e-3;
    settings.margin = margin;
    settings.max_faults = max_faults;
    return settings;
}

/// Correct, wrong, in percent, of Gaussian noise of 1 and faults of these sizes.
struct Rates {
    double correct = 0;
    double wrong = 0;
};

Rates rates(const std::string& layout, const DetectorSettings& settings, std::size_t faults, double least, double most, std::uint64_t seed)
{
    constexpr int trials = 20'000;
    const auto cluster = cluster_named(layout);
    const auto detector = SubsetDetector::make(settings, cluster).value();
    Random random(seed);
    int correct = 0;
    int wrong = 0;
    for (int k = 0; k < trials; ++k) {
        const AxisMask faulty = random.axes(faults, cluster.size());
        auto z = measure(cluster, random.body(10));
        for (std::size_t axis = 0; axis < cluster.size(); ++axis)
            z[axis] += random.normal() + (has_axis(faulty, axis) ? random.sign() * random.uniform(least, most) : 0);
        const auto assessment = assess(*detector, z);
        const bool right = assessment.outcome == (faulty == 0 ? Outcome::healthy : Outcome::isolated) && assessment.isolated == faulty;
        correct += right ? 1 : 0;
        wrong += !right && assessment.outcome == Outcome::isolated ? 1 : 0;
    }
    return {100.0 * correct / trials, 100.0 * wrong / trials};
}

// The sequential likelihood decision: correct %, dodecahedron. Four standard errors of 6000 and 20000 trials together are 2.8.
TEST(SubsetDetector, reaches_the_sequential_likelihood_decision_at_margin_0)
{
    EXPECT_GT(rates("dodecahedron", with(0), 0, 0, 0, 1).correct, 99.9 - 0.3);
    EXPECT_GT(rates("dodecahedron", with(0), 1, 5, 30, 2).correct, 96.3 - 1.1);
    EXPECT_GT(rates("dodecahedron", with(0), 2, 5, 30, 3).correct, 64.9 - 2.8);
    EXPECT_GT(rates("dodecahedron", with(0), 1, 20, 200, 4).correct, 99.9 - 0.3);
    EXPECT_GT(rates("dodecahedron", with(0), 2, 20, 200, 5).correct, 96.1 - 1.2);
}

TEST(SubsetDetector, would_rather_be_ambiguous_than_wrong_at_margin_9)
{
    const Rates guess = rates("dodecahedron", with(0), 2, 20, 200, 6);
    const Rates careful = rates("dodecahedron", with(9), 2, 20, 200, 6);
    EXPECT_GT(guess.wrong, 2);
    EXPECT_LT(careful.wrong, 0.1);
    EXPECT_GT(careful.correct, 86.1 - 2);
}

TEST(SubsetDetector, with_doubt_hardly_ever_takes_two_small_faults_for_one)
{
    auto doubting = with(9);
    doubting.doubt = 0.6;
    EXPECT_GT(rates("dodecahedron", with(9), 2, 5, 30, 7).wrong, 5);
    EXPECT_LT(rates("dodecahedron", doubting, 2, 5, 30, 7).wrong, 0.25);
}

TEST(SubsetDetector, doubts_a_small_fault_and_names_a_large_one_that_leaves_as_much)
{
    auto doubting = with(9);
    doubting.doubt = 0.5;
    const Rates small = rates("dodecahedron", doubting, 1, 20, 22, 9);
    const Rates large = rates("dodecahedron", doubting, 1, 100, 200, 10);
    EXPECT_NEAR(small.correct, 50, 1.5);  // the doubt, four standard errors
    EXPECT_GT(large.correct, 99.5);
    EXPECT_LT(rates("dodecahedron", doubting, 2, 5, 30, 11).wrong, 0.25);
}

/// S_w by deleting the rows of w and fitting the rest again.
double refitted(const geometry::SensorCluster& cluster, const std::vector<double>& z, AxisMask without)
{
    Eigen::MatrixXd rows(0, 3);
    Eigen::VectorXd values(0);
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        if (has_axis(without, axis)) continue;
        rows.conservativeResize(rows.rows() + 1, 3);
        values.conservativeResize(values.size() + 1);
        rows.bottomRows(1) = cluster.axes.row(static_cast<Eigen::Index>(axis));
        values(values.size() - 1) = z[axis];
    }
    return (values - rows * rows.colPivHouseholderQr().solve(values)).squaredNorm();
}

TEST(SubsetDetector, scores_every_set_as_a_fit_without_it)
{
    Random random(8);
    for (const auto* layout : {"cone-5", "dodecahedron", "octahedron-8", "cone-12"}) {
        const auto cluster = cluster_named(layout);
        const unsigned max_faults = cluster.size() == 5 ? 1 : 3;
        const auto detector = SubsetDetector::make(with(0, max_faults), cluster).value();
        for (int k = 0; k < 50; ++k) {
            const auto z = measure(cluster, random.body(100), {{random.below(cluster.size()), 30}, {random.below(cluster.size()), 50}});
            assess(*detector, z);
            for (const auto& score : detector->best())
                EXPECT_NEAR(score.statistic, refitted(cluster, z, score.axes), 1e-8) << layout << ", seed " << random.seed();
        }
    }
}

TEST(SubsetDetector, names_all_four_axes_where_parity_cannot_isolate)
{
    const auto cluster = cluster_named("cone-4");
    const auto detector = SubsetDetector::make(with(0, 1), cluster).value();
    const auto assessment = assess(*detector, measure(cluster, {1, 2, 3}, {{1, 50}}));
    EXPECT_EQ(assessment.outcome, Outcome::ambiguous);
    EXPECT_EQ(assessment.candidate_count, 4);
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3})).outcome, Outcome::healthy);
}

TEST(SubsetDetector, names_both_of_two_aligned_axes)
{
    const auto cluster = cluster_named("triads-2");
    const auto detector = SubsetDetector::make(with(0, 1), cluster).value();
    const auto assessment = assess(*detector, measure(cluster, {1, 2, 3}, {{1, 50}}));
    EXPECT_EQ(assessment.outcome, Outcome::ambiguous);
    ASSERT_EQ(assessment.candidate_count, 2);
    EXPECT_EQ(assessment.candidate[0] | assessment.candidate[1], axis_bit(1) | axis_bit(4));
}

TEST(SubsetDetector, isolates_an_instrument_of_three_whole_ones)
{
    auto settings = with(9, 1);
    settings.instruments = true;
    const auto three = cluster_named("triads-3");
    const auto detector = SubsetDetector::make(settings, three).value();
    const auto assessment = assess(*detector, measure(three, {1, 2, 3}, {{3, 20}, {4, -30}, {5, 15}}));
    EXPECT_EQ(assessment.outcome, Outcome::isolated);
    EXPECT_EQ(assessment.isolated, AxisMask{0b111000});

    const auto two = cluster_named("triads-2");
    const auto between_two = SubsetDetector::make(settings, two).value();
    EXPECT_EQ(assess(*between_two, measure(two, {1, 2, 3}, {{3, 20}, {4, -30}, {5, 15}})).outcome, Outcome::ambiguous);
}

TEST(SubsetDetector, isolates_two_of_eight_instruments)
{
    auto settings = with(9, 2);
    settings.instruments = true;
    const auto cluster = cluster_named("triads-8");
    const auto detector = SubsetDetector::make(settings, cluster).value();
    const auto assessment = assess(*detector, measure(cluster, {1, 2, 3}, {{4, 40}, {21, 40}}));
    EXPECT_EQ(assessment.outcome, Outcome::isolated);
    EXPECT_EQ(assessment.isolated, AxisMask{0b111} << 3 | AxisMask{0b111} << 21);
}

TEST(SubsetDetector, is_blind_to_more_faults_than_it_looks_for)
{
    const auto cluster = cluster_named("octahedron-8");
    const auto detector = SubsetDetector::make(with(9, 1), cluster).value();
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{0, 50}})).outcome, Outcome::isolated);
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{0, 50}, {2, 70}})).outcome, Outcome::blind);
}

TEST(SubsetDetector, isolates_a_fault_a_hundred_million_times_the_noise)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = SubsetDetector::make(with(9), cluster).value();
    const auto assessment = assess(*detector, measure(cluster, {1e3, 2e3, 3e3}, {{4, 1e8}}));
    EXPECT_EQ(assessment.isolated, axis_bit(4));
    EXPECT_EQ(assessment.outcome, Outcome::isolated);
}

TEST(SubsetDetector, weighs_each_axis_by_its_own_noise)
{
    auto cluster = cluster_named("dodecahedron");
    cluster.sigma = geometry::AxisVector::Ones(6);
    cluster.sigma(3) = 20;
    DetectorSettings settings;
    settings.pfa = 1e-3;
    const auto detector = SubsetDetector::make(settings, cluster).value();
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{3, 40}})).outcome, Outcome::healthy);
    const auto other = assess(*detector, measure(cluster, {1, 2, 3}, {{2, 40}}));
    EXPECT_EQ(other.outcome, Outcome::isolated);
    EXPECT_EQ(other.isolated, axis_bit(2));
}

TEST(SubsetDetector, refuses_what_it_cannot_serve_and_says_why)
{
    const auto refusal = [](const DetectorSettings& settings, const std::string& layout) {
        const auto made = SubsetDetector::make(settings, cluster_named(layout));
        return made ? std::string() : made.error();
    };
    EXPECT_NE(refusal(with(9, 1), "orthogonal-3").find("at least 4 axes"), std::string::npos);
    EXPECT_NE(refusal(with(9, 4), "dodecahedron").find("max_faults 4"), std::string::npos);
    EXPECT_NE(refusal(with(9, 6), "triads-8").find("lower max_faults"), std::string::npos);
    EXPECT_NE(refusal(with(-1), "dodecahedron").find("margin"), std::string::npos);
    EXPECT_NE(refusal(with(NAN), "dodecahedron").find("margin"), std::string::npos);
    EXPECT_NE(refusal({}, "dodecahedron").find("axis 0 has neither"), std::string::npos);
    EXPECT_EQ(refusal(with(9), "dodecahedron"), "");
}

}  // namespace
}  // namespace quorient::fdi
