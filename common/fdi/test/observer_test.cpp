#include "observer_scene.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "observers/observer_design.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace quorient;
using namespace quorient::fdi;
using namespace quorient::fdi::test;

namespace {

nlohmann::json cases_of(const std::string& method)
{
    const char* shared = std::getenv("QUORIENT_SHARED_DIR");
    const auto folder = shared != nullptr ? std::filesystem::path(shared) : std::filesystem::path(QUORIENT_SOURCE_DIR) / ".." / "shared";
    std::ifstream file(folder / "reference" / "cases.json");
    nlohmann::json found = nlohmann::json::array();
    if (!file) return found;
    const auto reference = nlohmann::json::parse(file);
    for (const auto& entry : reference["cases"]) {
        if (entry["method"] == method) found.push_back(entry);
    }
    return found;
}

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

ObserverBank paper_bank(ObserverScheme scheme)
{
    return ObserverBank::make(paper_settings(scheme), 0.01).value();
}

std::string refusal(const ObserverSettings& settings, double interval_s = 0.01)
{
    const auto bank = ObserverBank::make(settings, interval_s);
    return bank ? std::string("accepted") : bank.error();
}

struct Mean {
    double sum = 0;
    int count = 0;
    void add(double value)
    {
        sum += value;
        ++count;
    }
    double value() const { return sum / count; }
};

}  // namespace

TEST(ObserverDesign, gives_the_gains_of_the_reference_cases)
{
    const auto cases = cases_of("observer_synth");
    if (cases.empty()) GTEST_SKIP() << "no reference cases; set QUORIENT_SHARED_DIR";
    for (const auto& entry : cases) {
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

TEST(ObserverBank, follows_the_reference_run)
{
    const auto cases = cases_of("vessel_sim");
    if (cases.empty()) GTEST_SKIP() << "no reference cases; set QUORIENT_SHARED_DIR";
    auto directional = paper_bank(ObserverScheme::directional);
    auto blind = paper_bank(ObserverScheme::blind);
    std::size_t compared = 0;
    const auto compare = [&](ObserverBank& bank, std::size_t observer, const char* name) {
        follow(PaperRun{}, bank, [&](double time, const Eigen::VectorXd& state) {
            for (const auto& entry : cases) {
                if (std::abs(entry["input"]["t"].get<double>() - time) > 1e-6) continue;
                ++compared;
                for (Eigen::Index k = 0; k < 2; ++k) {
                    EXPECT_NEAR(bank.residual(observer)(k), entry["expected"][name][static_cast<std::size_t>(k)].get<double>(), 1e-9)
                        << name;
                    EXPECT_NEAR(state(k), entry["expected"]["x"][static_cast<std::size_t>(k)].get<double>(), 1e-9);
                }
            }
        });
    };
    compare(directional, 0, "r_Ka");
    compare(directional, 1, "r_Kg");
    compare(blind, 0, "r_gosA");
    compare(blind, 1, "r_gosG");
    EXPECT_EQ(compared, 4 * cases.size());
}

TEST(ObserverBank, reproduces_the_table_of_window_means)
{
    auto directional = paper_bank(ObserverScheme::directional);
    auto blind = paper_bank(ObserverScheme::blind);
    Mean quiet_a, quiet_g, gyro_a, gyro_g, acc_a, acc_g;
    follow(PaperRun{}, directional, [&](double time, const Eigen::VectorXd&) {
        if (time >= 5 && time < 20) quiet_a.add(directional.metric(0)), quiet_g.add(directional.metric(1));
        if (time >= 26 && time < 30) gyro_a.add(directional.metric(0)), gyro_g.add(directional.metric(1));
        if (time >= 60 && time < 70) acc_a.add(directional.metric(0)), acc_g.add(directional.metric(1));
    });
    EXPECT_LE(quiet_a.value(), 8.5e-6);
    EXPECT_LE(quiet_g.value(), 1.15e-5);
    EXPECT_NEAR(gyro_a.value(), .001174, .02 * .001174);
    EXPECT_NEAR(gyro_g.value(), .025528, .02 * .025528);
    EXPECT_NEAR(acc_a.value(), .005240, .02 * .005240);
    EXPECT_NEAR(acc_g.value(), .000168, .02 * .000168);

    std::array<std::array<Mean, 4>, 3> means;  // quiet, gyro, accelerometer; rA1, rA2, rG1, rG2
    follow(PaperRun{}, blind, [&](double time, const Eigen::VectorXd&) {
        const int window = time >= 5 && time < 20 ? 0 : time >= 26 && time < 30 ? 1 : time >= 60 && time < 70 ? 2 : -1;
        if (window < 0) return;
        for (std::size_t k = 0; k < 4; ++k)
            means[static_cast<std::size_t>(window)][k].add(std::abs(blind.residual(k / 2)(static_cast<Eigen::Index>(k % 2))));
    });
    const std::array<double, 4> quiet{1e-5, 1e-5, 2e-5, 2e-5}, gyro{.007619, .002356, 1.2e-5, .010009},
        acc{.009997, 4e-6, .002352, .006470};
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_LE(means[0][k].value(), quiet[k]) << k;
        EXPECT_NEAR(means[1][k].value(), gyro[k], std::max(.02 * gyro[k], 5e-7)) << k;  // 1.2e-5 and 4e-6 are printed to one digit
        EXPECT_NEAR(means[2][k].value(), acc[k], std::max(.02 * acc[k], 5e-7)) << k;
    }
}

TEST(ObserverBank, is_blind_to_the_fault_of_the_channel_that_an_observer_ignores)
{
    for (const double fault : {0.0, 0.01, 10.0}) {
        auto bank = paper_bank(ObserverScheme::blind);
        PaperRun run;
        run.gyro_fault = run.accelerometer_fault = fault;
        double worst = 0;
        follow(run, bank, [&](double time, const Eigen::VectorXd&) {
            if (time < 50) worst = std::max(worst, std::abs(bank.residual(1)(0)));
            else worst = std::max(worst, std::abs(bank.residual(0)(1)));
        });
        EXPECT_LT(worst, 4e-5) << "whatever its size: " << fault;
    }
}

TEST(ObserverDetector, isolates_every_sample_of_both_faults_by_the_blind_scheme)
{
    for (const double noise : {0.0, 2e-4}) {
        auto detector = ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value();
        int right_gyro = 0, right_acc = 0, alarms = 0;
        PaperRun run;
        run.noise = noise;
        follow(run, *detector, [&](double time, const Assessment& assessment) {
            const bool gyro = time >= 26 && time < 30, acc = time >= 60 && time < 70, quiet = time >= 5 && time < 20;
            right_gyro += gyro && assessment.outcome == Outcome::isolated && assessment.isolated == 0b10 ? 1 : 0;
            right_acc += acc && assessment.outcome == Outcome::isolated && assessment.isolated == 0b01 ? 1 : 0;
            alarms += quiet && assessment.outcome != Outcome::healthy ? 1 : 0;
        });
        EXPECT_EQ(right_gyro, 400) << "noise " << noise;
        EXPECT_EQ(right_acc, 1000) << "noise " << noise;
        EXPECT_EQ(alarms, 0) << "noise " << noise;
    }
}

TEST(ObserverBank, flags_the_right_channel_as_often_as_the_paper_by_the_directional_metrics)
{
    auto bank = paper_bank(ObserverScheme::directional);
    int right_gyro = 0, right_acc = 0, alarms = 0;
    follow(PaperRun{}, bank, [&](double time, const Eigen::VectorXd&) {
        const double a = bank.metric(0), g = bank.metric(1);
        right_gyro += time >= 20 && time < 30 && g > 1e-3 && g > a ? 1 : 0;
        right_acc += time >= 50 && time < 70 && a > 1e-3 && a > g ? 1 : 0;
        const bool quiet = (time >= 5 && time < 20) || (time >= 40 && time < 50) || time >= 79;
        alarms += quiet && std::max(a, g) > 1e-3 ? 1 : 0;
    });
    EXPECT_NEAR(right_gyro / 1000.0, .973, .0015);
    EXPECT_NEAR(right_acc / 2000.0, .924, .0015);
    EXPECT_EQ(alarms, 0);
}

TEST(ObserverDetector, never_names_the_wrong_channel_while_the_directions_form)
{
    auto detector = ObserverDetector::make(paper_settings(ObserverScheme::directional), 0.01).value();
    int right_gyro = 0, right_acc = 0, wrong = 0, seen_at_once = 0;
    follow(PaperRun{}, *detector, [&](double time, const Assessment& assessment) {
        const bool gyro = time >= 20 && time < 30, acc = time >= 50 && time < 70;
        right_gyro += gyro && assessment.isolated == 0b10 ? 1 : 0;
        right_acc += acc && assessment.isolated == 0b01 ? 1 : 0;
        wrong += (gyro && assessment.isolated == 0b01) || (acc && assessment.isolated == 0b10) ? 1 : 0;
        const bool onset = (time > 19.995 && time < 20.005) || (time > 49.995 && time < 50.005);
        seen_at_once += onset && assessment.outcome == Outcome::suspect ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(seen_at_once, 2) << "detection does not wait for attribution";
    EXPECT_GT(right_gyro, 740);
    EXPECT_GT(right_acc, 1740);
}

TEST(ObserverDetector, raises_no_alarm_without_a_fault)
{
    for (const auto scheme : {ObserverScheme::directional, ObserverScheme::blind}) {
        auto settings = paper_settings(scheme);
        settings.threshold.reset();
        settings.sigma = {2e-4};
        settings.false_alarm_probability = 1e-4;
        int alarms = 0, frames = 0;
        for (unsigned seed = 1; seed <= 20; ++seed) {
            auto detector = ObserverDetector::make(settings, 0.01).value();
            PaperRun run;
            run.noise = 2e-4;
            run.seed = seed;
            run.gyro_fault = run.accelerometer_fault = 0;
            follow(run, *detector, [&](double, const Assessment& assessment) {
                ++frames;
                alarms += assessment.outcome != Outcome::healthy ? 1 : 0;
            });
        }
        EXPECT_LE(alarms, 1.5e-4 * frames) << to_string(scheme) << ": 1e-4 were allowed";
    }
}

TEST(ObserverDetector, raises_alarms_as_often_as_it_was_allowed_to)
{
    auto settings = paper_settings(ObserverScheme::blind);
    settings.threshold.reset();
    settings.sigma = {2e-4};
    settings.false_alarm_probability = 0.02;
    int alarms = 0, frames = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        auto detector = ObserverDetector::make(settings, 0.01).value();
        PaperRun run;
        run.noise = 2e-4;
        run.seed = seed;
        run.gyro_fault = run.accelerometer_fault = run.rudder_rad = 0;
        follow(run, *detector, [&](double, const Assessment& assessment) {
            ++frames;
            alarms += assessment.outcome != Outcome::healthy ? 1 : 0;
        });
    }
    EXPECT_NEAR(alarms / static_cast<double>(frames), 0.02, 0.003) << "the quantile and the residual's variance are right";
}

TEST(ObserverDetector, survives_a_model_that_is_wrong_by_what_it_was_told)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> error(-0.05, 0.05);
    int alarms_told = 0, alarms_untold = 0, isolated = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        PaperRun run;
        run.noise = 2e-4;
        run.seed = seed;
        run.plant.a = run.plant.a.unaryExpr([&](double value) { return value * (1 + error(random)); });
        run.plant.b = run.plant.b.unaryExpr([&](double value) { return value * (1 + error(random)); });
        run.gyro_fault = run.accelerometer_fault = 0;
        auto settings = paper_settings(ObserverScheme::blind);
        settings.threshold.reset();
        settings.sigma = {2e-4};
        settings.false_alarm_probability = 1e-5;
        const auto count = [&](const PaperRun& played, auto predicate) {
            auto detector = ObserverDetector::make(settings, 0.01).value();
            int found = 0;
            follow(played, *detector, [&](double time, const Assessment& assessment) { found += predicate(time, assessment) ? 1 : 0; });
            return found;
        };
        const auto alarm = [](double, const Assessment& assessment) { return assessment.outcome != Outcome::healthy; };
        alarms_untold += count(run, alarm);
        settings.model_error = 0.05;
        alarms_told += count(run, alarm);
        run.gyro_fault = 0.03;
        isolated +=
            count(run, [](double time, const Assessment& assessment) { return time >= 20 && time < 30 && assessment.isolated == 0b10; });
    }
    EXPECT_LE(alarms_told, 8) << "of 320000 samples at 1e-5";
    EXPECT_GT(alarms_untold, 100) << "the bound is what it takes";
    EXPECT_GT(isolated, 40 * 1000 * 0.9) << "and a fault of 0.03 is still found";
}

TEST(ObserverDetector, goes_on_detecting_with_the_channel_that_is_left)
{
    auto detector = ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value();
    EXPECT_EQ(detector->detectable_remaining(), 1U);
    detector->exclude(0b10);
    EXPECT_EQ(detector->detectable_remaining(), 1U);
    int named = 0, alarms = 0;
    follow(PaperRun{}, *detector, [&](double time, const Assessment& assessment) {
        EXPECT_EQ(assessment.isolated & 0b10U, 0U) << "an excluded channel is not blamed";
        named += time >= 50 && time < 70 && assessment.isolated == 0b01 ? 1 : 0;
        const bool learning = time < 2.31 && assessment.outcome == Outcome::warming_up;
        alarms += time < 50 && assessment.outcome != Outcome::healthy && !learning ? 1 : 0;
    });
    EXPECT_EQ(named, 2000);
    EXPECT_EQ(alarms, 0) << "not even while the excluded channel is faulty";
    detector->exclude(0b11);
    EXPECT_EQ(detector->detectable_remaining(), 0U);
}

TEST(ObserverDetector, isolates_two_channels_of_five)
{
    std::mt19937 random(5);
    std::normal_distribution<double> gauss;
    LinearPlant plant{Eigen::MatrixXd{{-0.5, 1, 0}, {-1, -0.5, 0.3}, {0, 0, -0.8}}, Eigen::Vector3d(0, 1, 1),
                      Eigen::MatrixXd::NullaryExpr(5, 3, [&] { return gauss(random); })};
    ObserverSettings settings;
    settings.plant = plant;
    settings.poles = {{-2, -2.5, -3}};
    settings.threshold = 1e-3;
    for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = i; j < 5; ++j) {
            auto detector = ObserverDetector::make(settings, 0.01).value();
            const auto hold = geometry::zero_order_hold(plant.a, plant.b, 0.01);
            Eigen::VectorXd state = Eigen::VectorXd::Zero(3);
            Assessment assessment;
            for (std::uint64_t k = 0; k < 1000; ++k) {
                const double input = 0.01 * std::sin(0.01 * static_cast<double>(k));
                Eigen::VectorXd sample = plant.c * state;
                if (k >= 500) sample(static_cast<Eigen::Index>(i)) += 0.05;
                if (k >= 500 && j != i) sample(static_cast<Eigen::Index>(j)) -= 0.07;
                const Eigen::VectorXd increment = sample * 0.01;
                const std::array<double, 1> known{input};
                detector->assess({{1, k}, 0.01, {increment.data(), 5}, 0b11111, known}, assessment);
                if (k == 499) {
                    EXPECT_EQ(assessment.outcome, Outcome::healthy);
                }
                state = hold.state * state + hold.input * input;
            }
            EXPECT_EQ(assessment.outcome, Outcome::isolated) << i << " " << j;
            EXPECT_EQ(assessment.isolated, axis_bit(i) | axis_bit(j));
        }
    }
}

TEST(ObserverDetector, says_blind_while_the_rudder_stream_is_stopped_and_starts_again)
{
    auto detector = ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value();
    const std::array<double, 2> increment{0.0001, 0.0002};
    const std::array<double, 1> gone{std::nan("")};
    Assessment assessment;
    detector->assess({{1, 0}, 0.01, increment, 0b11, gone}, assessment);
    EXPECT_EQ(assessment.outcome, Outcome::blind);
    detector->assess({{1, 1}, 0.01, increment, 0b11, {}}, assessment);
    EXPECT_EQ(assessment.outcome, Outcome::blind);

    std::array<int, 2> seen{};
    std::uint64_t sequence = 0;
    PaperRun run;
    run.gyro_fault = run.accelerometer_fault = 0;
    run.play([&](double time, const Eigen::VectorXd&, const Eigen::VectorXd& sample, double rudder) {
        const std::array<double, 1> known{time >= 10 && time < 12 ? std::nan("") : rudder};
        const std::array<double, 2> increments{sample(0) * 0.01, sample(1) * 0.01};
        detector->assess({{2, sequence++}, 0.01, increments, 0b11, known}, assessment);
        ++seen[assessment.outcome == Outcome::blind ? 1 : 0];
        EXPECT_EQ(assessment.outcome, time >= 10 && time < 12 ? Outcome::blind : Outcome::healthy) << time;
    });
    EXPECT_EQ(seen[1], 200);
}

TEST(ObserverDetector, bridges_short_gaps_and_missing_samples)
{
    auto detector = ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value();
    std::uint64_t sequence = 0;
    Assessment assessment;
    int assessed = 0;
    PaperRun run;
    run.gyro_fault = run.accelerometer_fault = 0;
    run.play([&](double time, const Eigen::VectorXd&, const Eigen::VectorXd& sample, double rudder) {
        const std::uint64_t now = sequence++;
        if (now % 50 >= 45) return;
        const bool missing = now % 7 == 3;
        const std::array<double, 1> known{rudder};
        const std::array<double, 2> increments{missing ? 99.0 : sample(0) * 0.01, sample(1) * 0.01};
        detector->assess({{2, now}, 0.01, increments, missing ? 0b10U : 0b11U, known}, assessment);
        ++assessed;
        EXPECT_EQ(assessment.outcome, Outcome::healthy) << time;
    });
    EXPECT_EQ(assessed, 7201);
}

TEST(ObserverDetector, warms_up_where_the_samples_do_not_tell_the_whole_state)
{
    ObserverSettings settings;
    settings.plant = {Eigen::Matrix3d{{-1, 1, 0}, {0, -1, 1}, {0, 0, -1}}, Eigen::Vector3d(0, 0, 1),
                      Eigen::MatrixXd{{1, 0, 0}, {1, 0.5, 0}}};
    settings.poles = {{-2, -2.5, -3}};
    settings.threshold = 1e-2;
    auto detector = ObserverDetector::make(settings, 0.01).value();
    const auto hold = geometry::zero_order_hold(settings.plant.a, settings.plant.b, 0.01);
    Eigen::VectorXd state = Eigen::Vector3d(1, -2, 3);
    Assessment assessment;
    int warming = 0;
    for (std::uint64_t k = 0; k < 1000; ++k) {
        const Eigen::VectorXd increment = settings.plant.c * state * 0.01;
        detector->assess({{1, k}, 0.01, {increment.data(), 2}, 0b11, std::array<double, 1>{0.2}}, assessment);
        warming += assessment.outcome == Outcome::warming_up ? 1 : 0;
        EXPECT_EQ(assessment.outcome, k < 346 ? Outcome::warming_up : Outcome::healthy);
        state = hold.state * state + hold.input * 0.2;
    }
    EXPECT_EQ(warming, 346) << "ln(1000) / 2 s";
}

TEST(VesselMonitor, isolates_latches_and_readmits_the_papers_faults)
{
    const auto play = [](double gyro_fault, double accelerometer_fault) {
        auto monitor = FaultMonitor::make(ObserverDetector::make(paper_settings(ObserverScheme::blind), 0.01).value(), {}, 2).value();
        PaperRun run;
        run.gyro_fault = gyro_fault;
        run.accelerometer_fault = accelerometer_fault;
        std::array<FaultVerdict, 3> at;            // 19 s, 40 s, 75 s
        std::array<AxisMask, 2> contradicted = {};  // 25 s, 40 s
        SensorFrame frame;
        run.play([&](double time, const Eigen::VectorXd&, const Eigen::VectorXd& sample, double rudder) {
            frame.interval_s = run.interval_s;
            frame.valid_mask = 0b11;
            frame.known_input[0] = rudder;
            for (std::size_t channel : {std::size_t{0}, std::size_t{1}})
                frame.increment[channel] = sample(static_cast<Eigen::Index>(channel)) * run.interval_s;
            const FaultVerdict verdict = monitor.assess(frame);
            if (frame.sequence == 1900) at[0] = verdict;
            if (frame.sequence == 2500) contradicted[0] = monitor.contradicted(0b11);
            if (frame.sequence == 4000) contradicted[1] = monitor.contradicted(0b11);
            if (frame.sequence == 4000) at[1] = verdict;
            if (frame.sequence == 4000) monitor.readmit(0b11);
            if (time < 75.005) at[2] = verdict;
            ++frame.sequence;
        });
        return std::pair{at, contradicted};
    };
    const auto [faulty, contradicted] = play(0.01, 0.01);
    EXPECT_EQ(contradicted[0], 0b10U) << "while its fault lasts";
    EXPECT_EQ(contradicted[1], 0U) << "ten seconds after it";
    EXPECT_EQ(faulty[0].state, octet(VerdictState::healthy));
    EXPECT_EQ(faulty[1].state, octet(VerdictState::isolated)) << "latched, ten seconds after the fault ended";
    EXPECT_EQ(faulty[1].isolated_mask, 0b10U);
    EXPECT_NEAR(static_cast<double>(faulty[1].excluded_from[1]), 2000, 2);
    EXPECT_EQ(faulty[1].detectable_remaining, 1) << "the model stands behind the channel that is left";
    EXPECT_EQ(faulty[2].isolated_mask, 0b01U);
    EXPECT_NEAR(static_cast<double>(faulty[2].excluded_from[0]), 5000, 2);

    for (const FaultVerdict& verdict : play(0, 0).first) EXPECT_EQ(verdict.state, octet(VerdictState::healthy));
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
