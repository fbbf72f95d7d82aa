// What all single-frame methods have in common, and what each answers.

#include "single_frame/invariants_detector.hpp"
#include "single_frame/glt_detector.hpp"
#include "quorient/fdi/methods.hpp"
#include "single_frame/mean_detector.hpp"
#include "quorient/fdi/noise.hpp"
#include "single_frame/parity_set_detector.hpp"
#include "single_frame/voting_detector.hpp"
#include "test_clusters.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

namespace quorient::fdi {
namespace {

DetectorSettings settings_for(const std::string& method)
{
    DetectorSettings settings;
    settings.method = method;
    settings.sigma = 1;
    settings.bound = 4;
    return settings;
}

std::unique_ptr<Detector> detector_for(const std::string& method, const geometry::SensorCluster& cluster)
{
    auto made = make_detector(settings_for(method), cluster);
    EXPECT_TRUE(made) << method << ": " << made.error();
    return std::move(*made);
}

/// `auto` and every method that judges single rows.
std::vector<std::string> on_six_axes()
{
    std::vector<std::string> words{"auto"};
    for (const Method& method : methods())
        if (method.input == MethodInput::row) words.emplace_back(method.word);
    return words;
}

class EveryMethod : public testing::TestWithParam<std::string> {};

TEST_P(EveryMethod, is_silent_about_motion_however_fast)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = detector_for(GetParam(), cluster);
    Random random(11);
    for (int k = 0; k < 200; ++k)
        EXPECT_EQ(assess(*detector, measure(cluster, random.body(1e6))).outcome, Outcome::healthy) << "seed " << random.seed();
}

TEST_P(EveryMethod, is_silent_about_noise)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = detector_for(GetParam(), cluster);
    Random random(12);
    for (int k = 0; k < 2000; ++k) {
        auto z = measure(cluster, random.body(100));
        for (double& value : z) value += std::clamp(random.normal(), -3.9, 3.9);
        EXPECT_EQ(assess(*detector, z).outcome, Outcome::healthy) << "seed " << random.seed() << ", frame " << k;
    }
}

TEST_P(EveryMethod, names_the_one_faulty_axis)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = detector_for(GetParam(), cluster);
    for (std::size_t axis = 0; axis < 6; ++axis) {
        const auto assessment = assess(*detector, measure(cluster, {10, -20, 30}, {{axis, 200}}));
        EXPECT_EQ(assessment.outcome, Outcome::isolated) << "axis " << axis;
        EXPECT_EQ(assessment.isolated, axis_bit(axis));
        EXPECT_GT(assessment.statistic, assessment.threshold);
    }
}

TEST_P(EveryMethod, neither_reads_nor_blames_axes_that_are_left_out)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto cluster = cluster_named("octahedron-8");
    const auto detector = detector_for(GetParam(), cluster);
    Assessment assessment;
    auto z = measure(cluster, {1, 2, 3}, {{5, 300}});

    detector->exclude(axis_bit(5));
    detector->assess({.identity = {}, .increment = z, .valid = cluster.all()}, assessment);
    EXPECT_EQ(assessment.outcome, Outcome::healthy) << "excluded";
    detector->exclude(0);
    detector->assess({.identity = {}, .increment = z, .valid = cluster.all() & ~axis_bit(5)}, assessment);
    EXPECT_EQ(assessment.outcome, Outcome::healthy) << "not valid";
    z[5] = nan;
    detector->assess({.identity = {}, .increment = z, .valid = cluster.all()}, assessment);
    EXPECT_EQ(assessment.outcome, Outcome::healthy) << "not a number";
    z[5] = std::numeric_limits<double>::infinity();
    detector->assess({.identity = {}, .increment = z, .valid = cluster.all()}, assessment);
    EXPECT_EQ(assessment.outcome, Outcome::healthy) << "infinite";

    z = measure(cluster, {1, 2, 3}, {{5, 300}});
    detector->assess({.identity = {}, .increment = z, .valid = cluster.all()}, assessment);
    EXPECT_EQ(assessment.isolated, axis_bit(5)) << "the fault was really there";
}

TEST_P(EveryMethod, finds_the_second_fault_after_the_first_is_excluded)
{
    const auto cluster = cluster_named("octahedron-8");
    const auto detector = detector_for(GetParam(), cluster);
    detector->exclude(axis_bit(0));
    const auto assessment = assess(*detector, measure(cluster, {1, 2, 3}, {{0, 1e5}, {6, 300}}));
    EXPECT_EQ(assessment.outcome, Outcome::isolated);
    EXPECT_EQ(assessment.isolated, axis_bit(6));
}

TEST_P(EveryMethod, says_when_the_last_redundancy_is_gone)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = detector_for(GetParam(), cluster);
    EXPECT_EQ(detector->detectable_remaining(), 3U);
    detector->exclude(0b000111);
    EXPECT_EQ(detector->detectable_remaining(), 0U);
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{4, 1e5}})).outcome, Outcome::healthy);
    detector->exclude(0b000011);
    EXPECT_EQ(detector->detectable_remaining(), 1U);
    EXPECT_NE(assess(*detector, measure(cluster, {1, 2, 3}, {{4, 1e5}})).outcome, Outcome::healthy);
}

TEST_P(EveryMethod, serves_a_frame_without_any_axis)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = detector_for(GetParam(), cluster);
    Assessment assessment;
    detector->assess({.identity = {}, .increment = {}, .valid = cluster.all()}, assessment);
    EXPECT_EQ(assessment.isolated, 0U);
    EXPECT_EQ(assess(*detector, measure(cluster, {10, -20, 30}, {{2, 200}})).isolated, axis_bit(2));
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, testing::ValuesIn(on_six_axes()), [](const auto& test) {
    std::string name = test.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST(MakeDetector, refuses_bad_figures_for_every_method)
{
    const auto cluster = cluster_named("dodecahedron");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& method : on_six_axes())
        for (const double bad : {nan, -1.0, 0.0, std::numeric_limits<double>::infinity()}) {
            auto settings = settings_for(method);
            settings.sigma = bad;
            EXPECT_FALSE(make_detector(settings, cluster)) << method << ", sigma " << bad;
            settings = settings_for(method);
            settings.tolerance = bad;
            EXPECT_FALSE(make_detector(settings, cluster)) << method << ", tolerance " << bad;
            settings = settings_for(method);
            settings.pfa = bad;
            EXPECT_FALSE(make_detector(settings, cluster)) << method << ", pfa " << bad;
        }
}

TEST(MakeDetector, refuses_too_few_axes_and_says_why)
{
    for (const auto& [method, layout] : {std::pair{"glt", "orthogonal-3"},
                                         {"parity-set", "orthogonal-3"},
                                         {"mean", "cone-4"},
                                         {"voting", "cone-5"},
                                         {"invariants", "cone-5"},
                                         {"extrapolation", "cone-5"},
                                         {"vector", "dodecahedron"}}) {
        const auto made = make_detector(settings_for(method), cluster_named(layout));
        ASSERT_FALSE(made) << method;
        EXPECT_NE(made.error().find("axes"), std::string::npos) << made.error();
    }
}

TEST(MakeDetector, names_the_known_methods_when_asked_for_an_unknown_one)
{
    const auto made = make_detector(settings_for("majority"), cluster_named("dodecahedron"));
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().find("unknown detection method 'majority'"), std::string::npos);
    EXPECT_NE(made.error().find("subset"), std::string::npos);
}

TEST(MakeDetector, knows_every_method_that_it_lists)
{
    for (const auto& entry : methods()) {
        const bool four = entry.axes == "4";
        const bool array = entry.input == MethodInput::instruments;
        auto cluster = cluster_named(four ? "cone-4" : array ? "triads-3" : "dodecahedron");
        cluster.interval_s = 0.01;
        EXPECT_TRUE(make_detector(settings_for(std::string(entry.word)), cluster)) << entry.word;
    }
}

TEST(MakeDetector, s_methods_are_those_of_the_readme)
{
    std::ifstream file(std::string(QUORIENT_SOURCE_DIR "/common/fdi/README.md"));
    const std::string readme{std::istreambuf_iterator<char>(file), {}};
    ASSERT_FALSE(readme.empty());
    for (const Method& method : methods()) {
        const auto row = readme.find("\n| `" + std::string(method.word) + "` |");
        ASSERT_NE(row, std::string::npos) << method.word;
        const auto cells = readme.substr(row, readme.find('\n', row + 1) - row);
        EXPECT_NE(cells.find("| " + std::string(method.axes) + " |"), std::string::npos) << method.word << ": " << method.axes << " axes";
    }
}

TEST(Noise, is_that_of_a_quantiser_that_carries_its_remainder)
{
    auto cluster = cluster_named("dodecahedron");
    cluster.quantum = geometry::AxisVector::Constant(6, 0.5);
    const double sigma = sigma_of_axes({}, cluster).value()(0);
    const double bound = bound_of_axes({}, cluster).value()(0);

    Random random(13);
    double carried = 0;
    double sum_of_squares = 0;
    constexpr int frames = 200'000;
    for (int k = 0; k < frames; ++k) {
        const double increment = random.uniform(0, 10);
        const double total = increment + carried;
        const double counted = 0.5 * std::floor(total / 0.5);
        carried = total - counted;
        sum_of_squares += (counted - increment) * (counted - increment);
        ASSERT_LE(std::abs(counted - increment), bound);
    }
    EXPECT_NEAR(std::sqrt(sum_of_squares / frames), sigma, 0.01 * sigma);
}

TEST(Noise, quantiles_are_those_of_the_papers_thresholds)
{
    EXPECT_NEAR(chi_square_quantile(1, 1e-3), 10.828, 5e-4);
    EXPECT_NEAR(chi_square_quantile(3, 1e-3), 16.266, 5e-4);
    EXPECT_NEAR(chi_square_quantile(5, 1e-4), 25.745, 5e-4);
    EXPECT_NEAR(normal_quantile(1e-3 / 12), 3.7648, 5e-5);
}

TEST(GltDetector, is_ambiguous_among_all_four_axes)
{
    const auto cluster = cluster_named("cone-4");
    const auto detector = GltDetector::make(settings_for("glt"), cluster).value();
    const auto assessment = assess(*detector, measure(cluster, {1, 2, 3}, {{2, 100}}));
    EXPECT_EQ(assessment.outcome, Outcome::ambiguous);
    EXPECT_EQ(assessment.candidate_count, 4);
}

TEST(GltDetector, is_blind_to_two_faults_that_no_single_one_explains)
{
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = GltDetector::make(settings_for("glt"), cluster).value();
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{2, 100}, {5, 150}})).outcome, Outcome::blind);
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{2, 100}})).outcome, Outcome::isolated);
}

TEST(GltDetector, raises_false_alarms_as_often_as_it_was_told)
{
    auto settings = settings_for("glt");
    settings.pfa = 0.01;
    const auto cluster = cluster_named("dodecahedron");
    const auto by_residual = GltDetector::make(settings, cluster).value();
    const auto by_parity = ParitySetDetector::make(settings, cluster).value();
    Random random(14);
    int alarms = 0;
    constexpr int frames = 40'000;
    for (int k = 0; k < frames; ++k) {
        auto z = measure(cluster, random.body(10));
        for (double& value : z) value += random.normal();
        const auto first = assess(*by_residual, z);
        const auto second = assess(*by_parity, z);
        ASSERT_EQ(first.outcome, second.outcome) << "seed " << random.seed() << ", frame " << k;
        ASSERT_EQ(first.isolated, second.isolated);
        alarms += first.outcome == Outcome::healthy ? 0 : 1;
    }
    EXPECT_NEAR(static_cast<double>(alarms) / frames, 0.01, 4 * std::sqrt(0.01 * 0.99 / frames));
}

TEST(Mean, leaves_two_axes_out_and_not_a_third)
{
    auto settings = settings_for("mean");
    settings.tolerance = 1;
    const auto cluster = cluster_named("octahedron-8");
    const auto detector = MeanDetector::make(settings, cluster).value();
    const auto two = assess(*detector, measure(cluster, {1, 2, 3}, {{1, 50}, {4, -90}}));
    EXPECT_EQ(two.outcome, Outcome::isolated);
    EXPECT_EQ(two.isolated, axis_bit(1) | axis_bit(4));
    EXPECT_EQ(assess(*detector, measure(cluster, {1, 2, 3}, {{1, 50}, {4, -90}, {6, 160}})).outcome, Outcome::refused);
}

TEST(Invariants, relaxed_take_the_best_quadruple_where_the_strict_rule_refuses)
{
    // Two faults that cancel in one quadruple beyond the complementary one: 2 pass, which is no pattern.
    const std::vector<double> z{-393.04, 1075.35, -612.73, -593.11, 1254.79, -761.19};
    auto settings = settings_for("invariants");
    settings.tolerance = 3;
    const auto strict = InvariantsDetector::make(settings, cluster_named("guaranteed-cone")).value();
    settings.relaxed = true;
    const auto relaxed = InvariantsDetector::make(settings, cluster_named("guaranteed-cone")).value();
    settings.bare = true;
    const auto bare = InvariantsDetector::make(settings, cluster_named("guaranteed-cone")).value();
    EXPECT_EQ(assess(*strict, z).outcome, Outcome::refused);
    EXPECT_EQ(assess(*bare, z).isolated, axis_bit(1) | axis_bit(2));
    const auto rivalled = assess(*relaxed, z);  // the second quadruple that passes stands for a rival
    EXPECT_EQ(rivalled.outcome, Outcome::ambiguous);
    EXPECT_EQ(rivalled.candidate_count, 2);
    EXPECT_EQ(rivalled.isolated, 0U);
}

TEST(Invariants, relaxed_refuse_where_even_the_best_quadruple_fails)
{
    auto settings = settings_for("invariants");
    settings.tolerance = 1;
    settings.relaxed = true;
    const auto cluster = cluster_named("dodecahedron");
    const auto detector = InvariantsDetector::make(settings, cluster).value();
    const auto assessment = assess(*detector, measure(cluster, {1, 2, 3}, {{0, 50}, {1, 90}, {4, 170}}));
    EXPECT_EQ(assessment.outcome, Outcome::refused);
    EXPECT_EQ(assessment.isolated, 0U);
}

TEST(Voting, names_two_of_eight_axes_by_the_general_counts)
{
    auto settings = settings_for("voting");
    settings.tolerance = 1;
    const auto cluster = cluster_named("octahedron-8");
    const auto detector = VotingDetector::make(settings, cluster).value();
    EXPECT_EQ(detector->pair_count(), 56U * 55U / 2U);
    const auto assessment = assess(*detector, measure(cluster, {1, 2, 3}, {{1, 50}, {4, -90}}));
    EXPECT_EQ(assessment.isolated, axis_bit(1) | axis_bit(4));
    EXPECT_EQ(detector->passed_count(), 20U * 19U / 2U);
}

}  // namespace
}  // namespace quorient::fdi
