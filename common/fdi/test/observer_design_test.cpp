#include "observer_scene.hpp"
#include "reference_cases.hpp"
#include "observers/observer_design.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <string>

using namespace quorient;
using namespace quorient::fdi;
using namespace quorient::fdi::test;

namespace {

Eigen::MatrixXd matrix_of(const nlohmann::json& rows)
{
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows[0].size()));
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        for (Eigen::Index column = 0; column < matrix.cols(); ++column)
            matrix(row, column) = rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)].get<double>();
    }
    return matrix;
}

void expect_near(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected, double tolerance, const std::string& what)
{
    ASSERT_EQ(found.rows(), expected.rows()) << what;
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), tolerance) << what << "\n" << found << "\nexpected\n" << expected;
}

std::string refusal(const ObserverSettings& settings, double interval_s = 0.01)
{
    const auto bank = ObserverBank::make(settings, interval_s);
    return bank ? std::string("accepted") : bank.error();
}

}  // namespace

TEST(ObserverDesign, gives_the_gains_of_the_reference_cases)
{
    const auto cases = reference_cases("observer_synth");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& entry : *cases) {
        const auto& input = entry["input"];
        const Eigen::MatrixXd a = matrix_of(input["A"]);
        const double fault_pole = input["lambda_fault_direction"];
        const double other_pole = input["mu_other"];
        const Eigen::Index channel = input["channel_1based"].get<Eigen::Index>() - 1;
        const auto gain = directional_gain(a, channel, fault_pole, other_pole);
        ASSERT_TRUE(gain) << gain.error();
        expect_near(*gain, matrix_of(entry["expected"]["K_paper_k11_1"]), 1e-8 * gain->norm(), entry["id"]);

        const LinearPlant plant{a, Eigen::MatrixXd::Ones(2, 1), Eigen::Matrix2d::Identity()};
        const auto blind = blind_gain(plant, axis_bit(static_cast<std::size_t>(channel)), {fault_pole, other_pole});
        ASSERT_TRUE(blind) << blind.error();
        expect_near(*blind, matrix_of(entry["expected"]["K_gos_blind_to_channel"]), 1e-8 * blind->norm(), entry["id"]);
    }
}

TEST(ObserverDesign, gives_the_gains_of_the_paper_vessel)
{
    const auto a = paper_vessel().a;
    expect_near(directional_gain(a, 0, -3, -4).value(), Eigen::Matrix2d{{1, 2.88248337}, {.49438202, 2.97560976}}, 1e-8, "Ka");
    expect_near(directional_gain(a, 1, -.5, -4).value(), Eigen::Matrix2d{{1, -1.39024390}, {3.28947368, .47560976}}, 1e-8, "Kg");
    expect_near(blind_gain(paper_vessel(), 0b01, {-3, -4}).value(), Eigen::Matrix2d{{0, 4.90521064}, {0, 3.97560976}}, 1e-8, "without 0");
    expect_near(blind_gain(paper_vessel(), 0b10, {-3, -4}).value(), Eigen::Matrix2d{{3.97560976, 0}, {2.27150193, 0}}, 1e-8, "without 1");
}

TEST(ObserverDesign, keeps_the_error_in_the_fault_direction)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-3, 3);
    int designed = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const Eigen::Matrix2d a = Eigen::Matrix2d::NullaryExpr([&] { return uniform(random); });
        const double fault_pole = -0.2 - std::abs(uniform(random));
        const double other_pole = -0.1 - std::abs(uniform(random)) + fault_pole;
        const Eigen::Index channel = trial % 2;
        const auto gain = directional_gain(a, channel, fault_pole, other_pole);
        if (!gain || gain->norm() > 1e4) continue;
        ++designed;
        const Eigen::Vector2d direction = gain->col(channel);
        EXPECT_LT(((a - *gain) * direction - fault_pole * direction).norm(), 1e-7 * direction.norm() * (1 + gain->norm()))
            << "trial " << trial;
    }
    EXPECT_GT(designed, 1900);
}

TEST(ObserverDesign, places_the_poles_of_larger_plants_without_the_blind_channels)
{
    std::mt19937 random(11);
    std::normal_distribution<double> gauss;
    for (int trial = 0; trial < 200; ++trial) {
        const Eigen::Index n = 2 + trial % 5;
        const Eigen::Index p = 2 + trial % 3;
        LinearPlant plant{Eigen::MatrixXd::NullaryExpr(n, n, [&] { return gauss(random); }), Eigen::MatrixXd::Ones(n, 1),
                          Eigen::MatrixXd::NullaryExpr(p, n, [&] { return gauss(random); })};
        Poles poles{{-1, 0.5}, {-1, -0.5}};
        while (static_cast<Eigen::Index>(poles.size()) < n) poles.emplace_back(-1.0 - 0.7 * static_cast<double>(poles.size()));
        const auto gain = blind_gain(plant, 0b1, poles);
        ASSERT_TRUE(gain) << gain.error();
        EXPECT_EQ(gain->col(0).norm(), 0);
        Poles found = poles_of(plant.a - *gain * plant.c);
        for (const auto& wanted : poles) {
            const auto nearest =
                std::min_element(found.begin(), found.end(), [&](auto x, auto y) { return std::abs(x - wanted) < std::abs(y - wanted); });
            EXPECT_LT(std::abs(*nearest - wanted), 1e-3) << "trial " << trial;
        }
    }
}

TEST(ObserverDesign, places_the_poles_of_a_plant_whose_modes_share_one)
{
    const LinearPlant plant{-Eigen::Matrix3d::Identity(), Eigen::Vector3d::Ones(), Eigen::Matrix3d::Identity()};
    const auto one = blind_gain(plant, 0b001, {-2, -3, -4});
    ASSERT_TRUE(one) << one.error();
    EXPECT_EQ(observability(plant.a, plant.c.bottomRows(2)).unseen.rows(), 1) << "the blind channel's own mode, stable by itself";
}

TEST(ObserverDesign, leaves_a_stable_mode_that_nobody_sees_to_itself_and_refuses_an_unstable_one)
{
    LinearPlant plant{Eigen::Matrix2d{{-1, 0}, {0, -2}}, Eigen::Vector2d::Ones(), Eigen::Matrix2d::Identity()};
    EXPECT_TRUE(blind_gain(plant, 0b01, {-3, -4}));
    plant.a(0, 0) = 0.5;
    const auto refused = blind_gain(plant, 0b01, {-3, -4});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error(), "the sensors 1 cannot stabilise an observer: they do not see the plant's pole 0.5");
}

TEST(ObserverDesign, tells_when_the_metric_would_name_the_wrong_channel)
{
    const auto good = contrast(
        paper_vessel(), {directional_gain(paper_vessel().a, 0, -3, -4).value(), directional_gain(paper_vessel().a, 1, -.5, -4).value()});
    EXPECT_GT(good[0], 10);
    EXPECT_GT(good[1], 10);

    // A vessel with m = 10, I_z = 10, x_G = 0.5, u_0 = 3 and naive poles.
    LinearPlant other = paper_vessel();
    const Eigen::Matrix2d mass{{6.5, -2}, {0, 3}};
    other.a = -mass.inverse() * Eigen::Matrix2d{{-5, 23}, {-3, 8}};
    const auto bad = contrast(other, {directional_gain(other.a, 0, -3, -4).value(), directional_gain(other.a, 1, -3, -4).value()});
    EXPECT_LT(std::min(bad[0], bad[1]), 1);

    ObserverSettings settings = paper_settings(ObserverScheme::directional);
    settings.plant = other;
    settings.poles = {{-3, -4}};
    EXPECT_NE(refusal(settings).find("would name the wrong channel"), std::string::npos) << refusal(settings);
}

TEST(ObserverDesign, checks_each_of_the_papers_conditions)
{
    const Eigen::Matrix2d a = paper_vessel().a;
    const Eigen::MatrixXd ka = directional_gain(a, 0, -3, -4).value();
    const Eigen::MatrixXd kg = directional_gain(a, 1, -.5, -4).value();
    EXPECT_TRUE(check_conditions(a, {ka, kg}));
    EXPECT_NE(check_conditions(a, {ka + Eigen::Matrix2d{{0, 1}, {0, 0}}, kg}).error().find("condition 1"), std::string::npos);
    const Eigen::Matrix2d unstable = Eigen::Matrix2d{{1, 0}, {0, 2}};
    EXPECT_NE(check_conditions(unstable, {Eigen::Matrix2d{{0.5, 0}, {0, 0.1}}, kg}).error().find("condition 2"), std::string::npos);
    const Eigen::Matrix2d damped{{-1, 0}, {0, -1}};
    EXPECT_NE(check_conditions(damped, {Eigen::Matrix2d{{1, 1}, {1, 1}}, Eigen::Matrix2d{{1, 1}, {1, 1}}}).error().find("condition 3"),
              std::string::npos);
}

TEST(ObserverSettings, are_refused_with_the_reason)
{
    const auto with = [](ObserverScheme scheme, auto change) {
        ObserverSettings settings = paper_settings(scheme);
        change(settings);
        return refusal(settings);
    };
    const auto blind = ObserverScheme::blind;
    const auto directional = ObserverScheme::directional;
    EXPECT_EQ(with(blind, [](ObserverSettings&) {}), "accepted");
    EXPECT_EQ(with(directional, [](ObserverSettings&) {}), "accepted");
    EXPECT_EQ(with(blind, [](ObserverSettings& s) { s.plant.b = Eigen::MatrixXd::Ones(3, 1); }), "B must be 2 x 1, got 3 x 1");
    EXPECT_EQ(with(blind, [](ObserverSettings& s) { s.plant.a = Eigen::MatrixXd::Ones(2, 3); }), "A must be 2 x 2, got 2 x 3");
    EXPECT_EQ(with(blind, [](ObserverSettings& s) { s.plant.a(0, 0) = std::nan(""); }), "A holds a value that is not finite");
    EXPECT_EQ(with(blind,
                   [](ObserverSettings& s) {
                       s.poles = {{-3, 4}};
                   }),
              "the observer without channel 0: the observer would not be stable: pole 4 is not in the left half plane");
    EXPECT_EQ(with(blind, [](ObserverSettings& s) { s.poles = {{-3}}; }),
              "the observer without channel 0: 2 observer poles are needed, got 1");
    EXPECT_EQ(with(blind,
                   [](ObserverSettings& s) {
                       s.poles = {{{-3, 1}, {-4, 0}}};
                   }),
              "the observer without channel 0: pole -3+1i comes without its conjugate");
    EXPECT_NE(with(blind, [](ObserverSettings& s) { s.poles = {poles_of(s.plant.a)}; }).find("are the plant's own"), std::string::npos);
    EXPECT_NE(with(directional,
                   [](ObserverSettings& s) {
                       s.poles = {{-3, -4}, {-3, s.plant.a(1, 1)}};
                   })
                  .find("fault direction undefined"),
              std::string::npos);
    EXPECT_NE(with(directional, [](ObserverSettings& s) { s.plant.c(0, 1) = 1; }).find("C = I"), std::string::npos);
    EXPECT_NE(with(blind,
                   [](ObserverSettings& s) {
                       s.plant.c = Eigen::MatrixXd{{1, 0}};
                   })
                  .find("two channels or more"),
              std::string::npos);
    EXPECT_NE(with(blind, [](ObserverSettings& s) { s.threshold.reset(); }).find("nothing to compare residuals with"), std::string::npos);
    EXPECT_NE(with(blind, [](ObserverSettings& s) { s.sigma = {1, 2, 3}; }).find("one for each of the 2 channels"), std::string::npos);
    EXPECT_NE(with(blind, [](ObserverSettings& s) { s.model_error = -1; }).find("model_error"), std::string::npos);
    EXPECT_NE(refusal(paper_settings(blind), 0).find("interval"), std::string::npos);
    EXPECT_FALSE(parse_observer_scheme("luenberger"));
}
