#include "reference_cases.hpp"

#include "single_frame/guaranteed_detector.hpp"
#include "single_frame/invariants_detector.hpp"
#include "single_frame/glt_detector.hpp"
#include "single_frame/mean_detector.hpp"
#include "single_frame/parity_set_detector.hpp"
#include "single_frame/subset_detector.hpp"
#include "single_frame/voting_detector.hpp"

#include <gtest/gtest.h>

namespace quorient::fdi {
namespace {

using nlohmann::json;

std::unique_ptr<GuaranteedDetector> guaranteed_for(const json& input, double threshold)
{
    DetectorSettings settings;
    settings.bound = input["sigma"].get<double>();
    settings.threshold = threshold;
    settings.max_faults = 2;
    return GuaranteedDetector::make(settings, cluster_of(input["H"])).value();
}

void expect_interval(const GuaranteedDetector::Interval& interval, double lower, double upper, double tolerance)
{
    EXPECT_NEAR(interval.lower, lower, tolerance);
    EXPECT_NEAR(interval.upper, upper, tolerance);
}

void expect_guaranteed(const json& entry)
{
    const auto& expected = entry["expected"];
    const double tolerance = entry["tol"]["abs"].get<double>();
    const auto detector = guaranteed_for(entry["input"], entry["input"]["A"].get<double>());
    const auto assessment = assess(*detector, entry["input"]["z"].get<std::vector<double>>());

    ASSERT_EQ(detector->empty(), expected["empty"].get<bool>());
    std::vector<AxisMask> feasible;
    for (const auto& pair : expected["feasible_pairs_1based"]) feasible.push_back(mask_of(pair));
    ASSERT_EQ(detector->feasible_count(), feasible.size());
    for (std::size_t w = 0; w < detector->set_count(); ++w) {
        const bool listed = std::find(feasible.begin(), feasible.end(), detector->set(w)) != feasible.end();
        ASSERT_EQ(detector->feasible(w), listed) << "set " << w;
    }
    if (detector->empty()) {
        EXPECT_EQ(assessment.outcome, Outcome::blind);
        return;
    }
    for (std::size_t axis = 0; axis < 6; ++axis) {
        SCOPED_TRACE("axis " + std::to_string(axis));
        expect_interval(detector->interval(axis), expected["lmin"][axis].get<double>(), expected["lmax"][axis].get<double>(), tolerance);
        EXPECT_NEAR(assessment.residual[axis], expected["rho"][axis].get<double>(), tolerance);
        EXPECT_NEAR(assessment.bound[axis], expected["delta"][axis].get<double>(), tolerance);
        EXPECT_EQ(detector->decision(axis), expected["decision_FHU"].get<std::string>()[axis]);
    }
    for (std::size_t w = 0; w < detector->set_count(); ++w) {
        if (!detector->feasible(w)) continue;
        const AxisMask set = detector->set(w);
        const std::size_t first = static_cast<std::size_t>(std::countr_zero(set));
        const std::size_t second = static_cast<std::size_t>(std::bit_width(set)) - 1;
        const auto& intervals =
            expected["per_pair_intervals_Jmin_Imax_channels1to6"][std::to_string(first + 1) + "," + std::to_string(second + 1)];
        const auto axes = cluster_of(entry["input"]["H"]).axes;
        for (std::size_t axis = 0; axis < 6; ++axis)
            expect_interval(detector->interval_of(w, axes.row(static_cast<Eigen::Index>(axis)).transpose()),
                            intervals[axis][0].get<double>(), intervals[axis][1].get<double>(), tolerance);
    }
}

TEST(ReferenceCases, guaranteed_estimates_agree_with_180_linear_programs)
{
    const auto cases = reference_cases("guaranteed");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& entry : *cases) {
        SCOPED_TRACE(entry["id"].get<std::string>());
        expect_guaranteed(entry);
    }
}

TEST(ReferenceCases, guaranteed_directions_agree_with_linear_programs)
{
    const auto cases = reference_cases("guaranteed_dir");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& entry : *cases) {
        SCOPED_TRACE(entry["id"].get<std::string>());
        const auto& input = entry["input"];
        const auto detector = guaranteed_for(input, 10);
        assess(*detector, input["z"].get<std::vector<double>>());

        const Eigen::Vector3d direction(input["a"][0].get<double>(), input["a"][1].get<double>(), input["a"][2].get<double>());
        std::size_t pair = 0;
        while (detector->set(pair) != mask_of(input["pair_1based"])) ++pair;
        expect_interval(detector->interval_of(pair, direction), entry["expected"]["J_min"].get<double>(),
                        entry["expected"]["I_max"].get<double>(), entry["tol"]["abs"].get<double>());
    }
}

DetectorSettings with_tolerance(double tolerance)
{
    DetectorSettings settings;
    settings.tolerance = tolerance;
    settings.max_faults = 2;
    return settings;
}

void expect_decision(const json& expected, const Assessment& assessment)
{
    if (expected == "REFUSE") {
        EXPECT_EQ(assessment.outcome, Outcome::refused);
        EXPECT_EQ(assessment.isolated, 0U);
        return;
    }
    EXPECT_EQ(assessment.isolated, mask_of(expected));
    EXPECT_EQ(assessment.outcome, expected.empty() ? Outcome::healthy : Outcome::isolated);
}

void expect_sums_of_squares(const json& entry, const geometry::SensorCluster& cluster, const std::vector<double>& z)
{
    const double tolerance = 1e-9 + 1e-12 * entry["expected"]["SSE0"].get<double>();
    DetectorSettings settings;
    settings.sigma = 1;
    settings.pfa = 0.999999;  // every frame goes through the subsets
    settings.max_faults = 2;
    const auto detector = SubsetDetector::make(settings, cluster).value();
    const auto assessment = assess(*detector, z);
    EXPECT_NEAR(assessment.statistic, entry["expected"]["SSE0"].get<double>(), tolerance);
    if (assessment.outcome == Outcome::healthy) return;

    const auto& pairs = entry["expected"]["SSE2_lexicographic_pairs"];
    const auto least =
        std::min_element(pairs.begin(), pairs.end(), [](const json& a, const json& b) { return a.get<double>() < b.get<double>(); });
    ASSERT_FALSE(detector->best().empty());
    EXPECT_EQ(detector->best()[0].axes, mask_of(entry["expected"]["ml_best_pair_1based"]));
    EXPECT_NEAR(detector->best()[0].statistic, least->get<double>(), tolerance);
}

TEST(ReferenceCases, invariants_voting_and_mean_decide_as_the_independent_computation)
{
    const auto cases = reference_cases("voting_invariants_mean");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& entry : *cases) {
        SCOPED_TRACE(entry["id"].get<std::string>());
        const auto& input = entry["input"];
        const auto& expected = entry["expected"];
        const auto cluster = cluster_of(input["H"]);
        const auto z = input["z"].get<std::vector<double>>();

        const auto invariants = InvariantsDetector::make(with_tolerance(input["T_invariant_unit_norm"].get<double>()), cluster).value();
        expect_decision(expected["invariants"], assess(*invariants, z));
        const auto passed = invariants->passed();
        EXPECT_EQ(std::count(passed.begin(), passed.end(), 1), expected["n_pass_invariants"].get<int>());
        for (std::size_t k = 0; k < 15; ++k)
            EXPECT_NEAR(invariants->values()[k], expected["abs_invariants_lexicographic_quads"][k].get<double>(),
                        entry["tol"]["abs"].get<double>());

        const auto voting = VotingDetector::make(with_tolerance(input["T_vote_vectornorm"].get<double>()), cluster).value();
        expect_decision(expected["voting"], assess(*voting, z));
        EXPECT_EQ(voting->passed_count(), expected["n_pass_voting"].get<std::size_t>());

        auto mean_settings = with_tolerance(input["T_mean_sqrtSSE"].get<double>());
        mean_settings.bare = true;
        const auto mean = MeanDetector::make(mean_settings, cluster).value();
        const auto assessment = assess(*mean, z);
        if (expected["mean_unresolved_after_2"].get<bool>()) EXPECT_EQ(assessment.outcome, Outcome::refused);
        else expect_decision(expected["mean"], assessment);
        EXPECT_NEAR(assessment.statistic * assessment.statistic, expected["SSE0"].get<double>(), entry["tol"]["abs"].get<double>());

        expect_sums_of_squares(entry, cluster, z);
    }
}

TEST(ReferenceCases, one_likelihood_ratio_core_gives_potter_suman_and_glr)
{
    const auto cases = reference_cases("potter_suman_glr");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& entry : *cases) {
        SCOPED_TRACE(entry["id"].get<std::string>());
        const auto& input = entry["input"];
        const auto& expected = entry["expected"];
        const double tolerance = entry["tol"]["abs"].get<double>();
        const double sigma = input["sigma"].get<double>();
        const auto cluster = cluster_of(input["H"]);
        const auto m = input["m"].get<std::vector<double>>();
        DetectorSettings settings;
        settings.sigma = sigma;
        settings.pfa = 1e-3;

        const auto detector = GltDetector::make(settings, cluster).value();
        const auto assessment = assess(*detector, m);
        const std::size_t best = expected["isolated_1based"].get<std::size_t>() - 1;
        EXPECT_NEAR(assessment.statistic * sigma * sigma, expected["sse"].get<double>(), tolerance);
        EXPECT_EQ(assessment.isolated, axis_bit(best));
        EXPECT_NEAR(detector->parity(best), expected["bias_estimate"].get<double>(), tolerance);
        for (std::size_t axis = 0; axis < m.size(); ++axis) {
            EXPECT_NEAR(detector->explained(axis), expected["glr"][axis].get<double>(), tolerance);
            EXPECT_NEAR(detector->parity(axis), expected["p_n"][axis].get<double>(), tolerance);
        }

        const auto minimal = ParitySetDetector::make(settings, cluster).value();
        const auto same = assess(*minimal, m);
        EXPECT_NEAR(minimal->parity().squaredNorm(), expected["sse"].get<double>(), tolerance);
        EXPECT_EQ(same.isolated, axis_bit(best));
        EXPECT_EQ(same.outcome, assessment.outcome);
    }
}

}  // namespace
}  // namespace quorient::fdi
