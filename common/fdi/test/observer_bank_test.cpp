#include "observer_scene.hpp"
#include "reference_cases.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>

using namespace quorient;
using namespace quorient::fdi;
using namespace quorient::fdi::test;

namespace {

ObserverBank paper_bank(ObserverScheme scheme)
{
    return ObserverBank::make(paper_settings(scheme), 0.01).value();
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

TEST(ObserverBank, follows_the_reference_run)
{
    const auto cases = reference_cases("vessel_sim");
    QUORIENT_SKIP_WITHOUT(cases);
    auto directional = paper_bank(ObserverScheme::directional);
    auto blind = paper_bank(ObserverScheme::blind);
    std::size_t compared = 0;
    const auto compare = [&](ObserverBank& bank, std::size_t observer, const char* name) {
        follow(PaperRun{}, bank, [&](double time, const Eigen::VectorXd& state) {
            for (const auto& entry : *cases) {
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
    EXPECT_EQ(compared, 4 * cases->size());
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
