#include "quorient/simulation/vessel.hpp"

#include "reference_cases.hpp"

#include <gtest/gtest.h>
#include <cmath>

using namespace quorient;
using namespace quorient::simulation;

namespace {

VesselScenario paper_scenario()
{
    VesselScenario scenario;
    scenario.model = nomoto({}).value();
    scenario.faults = paper_faults();
    return scenario;
}

}  // namespace

TEST(Vessel, has_the_matrices_of_the_printed_coefficients)
{
    const auto model = nomoto({}).value();
    EXPECT_LT((model.a - Eigen::MatrixXd{{0.3414634146341463, -1.8536585365853657}, {2.1463414634146343, -3.3658536585365857}}).norm(),
              1e-14);
    EXPECT_LT((model.b - Eigen::MatrixXd{{0.1951219512195122}, {3.5121951219512195}}).norm(), 1e-14);
}

TEST(Vessel, moves_as_in_the_reference_run)
{
    const auto cases = test::reference_cases("vessel_sim");
    QUORIENT_SKIP_WITHOUT(cases);
    std::size_t compared = 0;
    for (const auto& entry : *cases) {
        SimulatedVessel vessel(paper_scenario());
        SensorFrame frame;
        Eigen::VectorXd state;
        while (vessel.next(frame, state)) {
            if (std::abs(static_cast<double>(frame.sequence) * 0.01 - entry["input"]["t"].get<double>()) > 1e-6) continue;
            ++compared;
            for (Eigen::Index k = 0; k < 2; ++k)
                EXPECT_NEAR(state(k), entry["expected"]["x"][static_cast<std::size_t>(k)].get<double>(), 1e-9);
        }
    }
    EXPECT_GE(compared, 3U);
}

TEST(Vessel, has_the_faults_of_the_paper_and_nothing_else)
{
    VesselScenario healthy = paper_scenario();
    healthy.faults.clear();
    SimulatedVessel faulty_vessel(paper_scenario()), healthy_vessel(healthy);
    SensorFrame faulty, clean;
    Eigen::VectorXd state;
    while (faulty_vessel.next(faulty, state) && healthy_vessel.next(clean, state)) {
        const double time = static_cast<double>(clean.sequence) * 0.01;
        const bool gyro = clean.sequence >= 2000 && clean.sequence < 3000, sway = clean.sequence >= 5000 && clean.sequence < 7000;
        EXPECT_NEAR((faulty.increment[0] - clean.increment[0]) / 0.01, sway ? 0.01 : 0, 1e-15) << time;
        EXPECT_NEAR((faulty.increment[1] - clean.increment[1]) / 0.01, gyro ? 0.01 : 0, 1e-15) << time;
        EXPECT_NEAR(clean.increment[0] / 0.01, state(0), 1e-15);
    }
    EXPECT_EQ(clean.sequence, 8000U);
}

TEST(Vessel, has_noise_of_the_stated_size)
{
    VesselScenario scenario = paper_scenario();
    scenario.faults.clear();
    scenario.noise = 2e-4;
    scenario.seed = 3;
    SimulatedVessel vessel(scenario);
    SensorFrame frame;
    Eigen::VectorXd state;
    double sum = 0, squares = 0, cross = 0;
    while (vessel.next(frame, state)) {
        const double sway = frame.increment[0] / 0.01 - state(0), yaw = frame.increment[1] / 0.01 - state(1);
        sum += sway;
        squares += sway * sway + yaw * yaw;
        cross += sway * yaw;
    }
    EXPECT_NEAR(std::sqrt(squares / 16002), 2e-4, 4e-6);
    EXPECT_NEAR(sum / 8001, 0, 8e-6);
    EXPECT_NEAR(cross / 8001, 0, 2e-9);
}

TEST(Vessel, refuses_what_cannot_be_simulated)
{
    VesselCoefficients impossible;
    impossible.mass = impossible.y_v_dot;
    impossible.n_v_dot = impossible.mass * impossible.centre_of_mass_x;
    EXPECT_NE(nomoto(impossible).error().find("singular"), std::string::npos);

    const auto refusal = [](auto change) {
        VesselScenario scenario = paper_scenario();
        change(scenario);
        const auto checked = check(scenario);
        return checked ? std::string() : checked.error();
    };
    EXPECT_EQ(refusal([](VesselScenario&) {}), "");
    EXPECT_NE(refusal([](VesselScenario& s) { s.model.b = Eigen::MatrixXd::Ones(3, 1); }).find("B must be 2 x 1"), std::string::npos);
    EXPECT_NE(refusal([](VesselScenario& s) { s.interval_s = 0; }).find("interval"), std::string::npos);
    EXPECT_NE(refusal([](VesselScenario& s) { s.noise = -1; }).find("noise"), std::string::npos);
    EXPECT_NE(refusal([](VesselScenario& s) { s.faults[0].axes = axis_bit(5); }).find("axis"), std::string::npos);
}
