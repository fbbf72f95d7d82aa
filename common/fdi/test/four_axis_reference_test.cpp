// The four-axis methods against the worked cases and tables of paper 003.

#include "coning_model.hpp"
#include "four_axes/extrapolation_detector.hpp"
#include "four_axes/vector_detector.hpp"
#include "quorient/geometry/layouts.hpp"
#include "reference_cases.hpp"

#include <gtest/gtest.h>

#include <map>

namespace quorient::fdi {
namespace {

constexpr double quantum = 0.4848e-6;

Eigen::Vector3d vector_of(const nlohmann::json& values)
{
    return {values[0].get<double>(), values[1].get<double>(), values[2].get<double>()};
}

Assessment feed(Detector& detector, std::uint64_t sequence, const Eigen::Vector4d& z)
{
    Assessment assessment;
    detector.assess({.identity = {1, sequence}, .interval_s = 0.1, .increment = std::span(z.data(), 4), .valid = 0b1111}, assessment);
    return assessment;
}

TEST(FourAxisReference, triads_and_parity_match_the_worked_cases)
{
    const auto cases = reference_cases("triads");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& entry : *cases) {
        SCOPED_TRACE(entry["id"].get<std::string>());
        const auto detector = ExtrapolationDetector::make({.tolerance = 1.0}, cluster_of(entry["input"]["H"])).value();
        const auto& q = entry["input"]["quasi_coordinates"];
        const Eigen::Vector4d z(q[0].get<double>(), q[1].get<double>(), q[2].get<double>(), q[3].get<double>());
        const Assessment assessment = feed(*detector, 0, z);
        const auto& expected = entry["expected"];
        const double tolerance = entry["tol"]["abs"];
        for (std::size_t k = 0; k < 4; ++k) {
            EXPECT_NEAR(detector->triad_modulus()[k], expected["triad_modulus"][k].get<double>(), tolerance);
            EXPECT_LE((detector->triad(k).body(z) - vector_of(expected["triad_body"][k])).cwiseAbs().maxCoeff(), tolerance);
        }
        EXPECT_NEAR(assessment.statistic, std::abs(expected["parity_unit_v4positive"].get<double>()), tolerance);
    }
}

TEST(FourAxisReference, the_coning_model_of_these_tests_matches_the_worked_cases)
{
    const auto cases = reference_cases("kinematics");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& entry : *cases) {
        SCOPED_TRACE(entry["id"].get<std::string>());
        const auto& in = entry["input"];
        const ConingModel motion{.k2 = in["k2"], .k3 = in["k3"], .mu = in["mu"], .nu = in["nu"]};
        const auto& expected = entry["expected"];
        const double tolerance = entry["tol"]["abs"];
        const auto& q = expected["q"];
        const Eigen::Vector4d attitude(q[0].get<double>(), q[1].get<double>(), q[2].get<double>(), q[3].get<double>());
        EXPECT_LE((motion.attitude(in["t"]) - attitude).cwiseAbs().maxCoeff(), tolerance);
        EXPECT_LE((motion.rate(in["t"]) - vector_of(expected["omega"])).cwiseAbs().maxCoeff(), tolerance);
        EXPECT_LE((motion.increment(in["t"], in["h"]) - vector_of(expected["increment_t_to_t_plus_h"])).cwiseAbs().maxCoeff(), tolerance);
    }
}

TEST(FourAxisReference, the_predictor_matches_the_worked_cases)
{
    const auto cases = reference_cases("prony");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& entry : *cases) {
        SCOPED_TRACE(entry["id"].get<std::string>());
        const auto moduli = entry["input"]["theta_nm4_to_nm1"].get<std::array<double, 4>>();
        const auto& expected = entry["expected"];
        const double relative = entry["tol"]["rel"];
        const ModulusPrediction prediction = predict_modulus(moduli, quantum);
        EXPECT_NEAR(prediction.predicted / expected["pred"].get<double>(), 1, relative);
        EXPECT_NEAR(prediction.z1 / expected["z1"].get<double>(), 1, relative);
        EXPECT_NEAR(prediction.z2 / expected["z2"].get<double>(), 1, relative);
        EXPECT_NEAR(prediction.determinant / expected["det"].get<double>(), 1, relative);
        EXPECT_EQ(prediction.fallback, ModulusFallback::none);
    }
}

/// Tables 2-4: the body increments are truncated, projected, and sensor G2 scaled by 0.8 in the frame that ends at 10.1 s.
struct Table {
    const char* layout;
    std::array<double, 4> modulus;  ///< for T1..T4, the misprints corrected (methods of paper 003)
};

class PaperTables : public ::testing::TestWithParam<Table> {
protected:
    static Eigen::Vector4d frame(const geometry::SensorCluster& cluster, double begin_s, double factor)
    {
        const Eigen::Vector3d exact = ConingModel{}.increment(begin_s, 0.1);
        const Eigen::Vector3d truncated = (exact / quantum).array().unaryExpr([](double x) { return std::trunc(x); }) * quantum;
        Eigen::Vector4d z = cluster.axes * truncated;
        z(1) *= factor;
        return z;
    }
};

TEST_P(PaperTables, name_the_second_sensor_with_the_printed_moduli)
{
    auto cluster = geometry::layout(GetParam().layout).value();
    cluster.quantum.setConstant(quantum);
    const auto modulus = ExtrapolationDetector::make({}, cluster).value();
    const auto vector = VectorDetector::make({}, cluster).value();
    for (std::uint64_t row = 0; row < 40; ++row) {
        const Eigen::Vector4d z = frame(cluster, 6.0 + 0.1 * static_cast<double>(row), 1.0);
        const Outcome expected = row < 4 ? Outcome::warming_up : Outcome::healthy;
        EXPECT_EQ(feed(*modulus, row, z).outcome, expected) << "row " << row;
        EXPECT_EQ(feed(*vector, row, z).outcome, expected) << "row " << row;
    }
    const Eigen::Vector4d faulty = frame(cluster, 10.0, 0.8);
    EXPECT_EQ(feed(*modulus, 40, faulty).isolated, 0b0010U);
    EXPECT_EQ(feed(*vector, 40, faulty).isolated, 0b0010U);
    EXPECT_EQ(modulus->working_triad(), 2U) << "T3";
    EXPECT_EQ(vector->working_triad(), 2U) << "T3";
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(modulus->triad_modulus()[k], GetParam().modulus[k], 0.5e-10 + 1e-12) << "T" << k + 1;
    EXPECT_NEAR(modulus->prediction()->predicted, 0.0097749751, 1e-10) << "on truncated data; the printed theta** is another";
}

INSTANTIATE_TEST_SUITE_P(Paper003, PaperTables,
                         ::testing::Values(Table{"orthogonal-3-plus-1", {.0087201327, .0081423139, .0097748732, .0096400132}},
                                           Table{"cone-4", {.0077699637, .0084411479, .0097748732, .0079689709}},
                                           Table{"cone-3-axis", {.0078168378, .0081347854, .0097748732, .0079425595}}),
                         [](const auto& tested) { return "table_" + std::to_string(tested.index + 2); });

TEST(FourAxisReference, tables_match_the_worked_cases)
{
    const auto cases = reference_cases("table003");
    QUORIENT_SKIP_WITHOUT(cases);
    const std::map<std::string, std::string> layout_of{{"3+1", "orthogonal-3-plus-1"}, {"cone4", "cone-4"}, {"cone3a", "cone-3-axis"}};
    for (const auto& entry : *cases) {
        const auto& in = entry["input"];
        const auto cluster = geometry::layout(layout_of.at(in["config"])).value();
        const ConingModel motion{.k2 = in["k2"], .k3 = in["k3"]};
        const double epsilon = in["eps"];
        const Eigen::Vector3d exact = motion.increment(in["t0"], in["h"]);
        const Eigen::Vector3d truncated = (exact / epsilon).array().unaryExpr([](double x) { return std::trunc(x); }) * epsilon;
        Eigen::Vector4d z = cluster.axes * truncated;
        z(1) *= 0.8;
        const auto detector = ExtrapolationDetector::make({.tolerance = 1e-5}, cluster).value();
        feed(*detector, 0, z);
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_NEAR(detector->triad_modulus()[k], entry["expected"]["moduli"][k].get<double>(), entry["tol"]["abs"].get<double>());
    }
}

TEST(ModulusPredictor, is_exact_for_sums_of_two_exponentials)
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> factor(0.7, 1.3), part(0.2, 1);
    for (int trial = 0; trial < 1000; ++trial) {
        const double u1 = factor(random), u2 = factor(random), c1 = part(random), c2 = part(random);
        if (std::abs(u1 - u2) < 0.05) continue;  // ill-conditioned
        const auto modulus = [&](double n) { return c1 * std::pow(u1, n) + c2 * std::pow(u2, n); };
        const ModulusPrediction prediction = predict_modulus({modulus(0), modulus(1), modulus(2), modulus(3)}, quantum);
        EXPECT_EQ(prediction.fallback, ModulusFallback::none);
        EXPECT_NEAR(prediction.predicted, modulus(4), 1e-9);
    }
}

TEST(ModulusPredictor, names_what_it_falls_back_on_where_the_determinant_is_singular)
{
    const ModulusPrediction rest = predict_modulus({0, 0, 0, 0}, quantum);
    EXPECT_EQ(rest.fallback, ModulusFallback::mean);
    EXPECT_EQ(rest.predicted, 0);

    const ModulusPrediction constant = predict_modulus({0.01, 0.01, 0.01, 0.01}, quantum);
    EXPECT_EQ(constant.fallback, ModulusFallback::mean);
    EXPECT_DOUBLE_EQ(constant.predicted, 0.01);
    EXPECT_EQ(constant.z1, 0);

    const ModulusPrediction slow = predict_modulus({0.01, 0.01001, 0.01001 * 1.001, 0.01001 * 1.001 * 1.001}, quantum);
    EXPECT_EQ(slow.fallback, ModulusFallback::line);
    EXPECT_NEAR(slow.predicted, 0.01 * std::pow(1.001, 4), 1e-7);

    const ModulusPrediction fast = predict_modulus({1, 2, 4, 8}, quantum);  // one exponential: b^2 = a c
    EXPECT_EQ(fast.fallback, ModulusFallback::quadratic);
    EXPECT_EQ(fast.predicted, 3 * 8 - 3 * 4 + 2);
    EXPECT_EQ(name(fast.fallback), "quadratic");
}

}  // namespace
}  // namespace quorient::fdi
