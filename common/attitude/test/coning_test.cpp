#include "coning.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace quorient::attitude {
namespace {

using namespace testing;

struct Cone {
    double half_angle_deg;
    double frequency_hz;
    double sampling_hz;
};

double drift_deg_h(std::string_view algorithm, const Cone& cone, double duration_s = 600)
{
    const ClassicConing motion(cone.half_angle_deg, cone.frequency_hz);
    return deg_per_hour(error_after(algorithm, motion, 1 / cone.sampling_hz, duration_s), duration_s);
}

TEST(ConingDrift, of_the_window_of_ten_is_at_the_floor_from_the_first_row_on)
{
    EXPECT_LE(drift_deg_h("window-10", {10, 1, 100}), 1e-8);
    EXPECT_LE(drift_deg_h("window-10", {10, 2, 100}), 1e-6);
    EXPECT_LE(drift_deg_h("window-10", {10, 5, 100}), 5e-2);
    EXPECT_LE(drift_deg_h("window-10", {60, 1, 100}), 1e-8);
}

// docs/methods/coning.md, "Verified numbers", to the two digits printed there (for `previous` and `window-8` the rest is start-up).
TEST(ConingDrift, of_the_classical_rules_is_as_tabulated)
{
    struct Row {
        const char* algorithm;
        double expected;
    };
    for (const auto& [algorithm, expected] :
         {Row{"single", 12.9}, Row{"previous", 1.0e-2}, Row{"two-sample", 9.9e-3}, Row{"three-sample-miller", 9.1e-5}})
        EXPECT_NEAR(drift_deg_h(algorithm, {10, 1, 100}), expected, 0.06 * expected) << algorithm;
    EXPECT_NEAR(drift_deg_h("window-8", {10, 5, 100}), 3.8e-2, 0.06 * 3.8e-2);
    EXPECT_NEAR(drift_deg_h("window-10", {10, 5, 100}), 3.2e-3, 0.06 * 3.2e-3);
}

// The whole map is printed by attitude_coning_map; here its corners and what lies between, over 60 s.
TEST(ConingDrift, is_nowhere_worse_than_one_twelfth_up_to_a_tenth_of_the_sampling_rate)
{
    for (const double sampling_hz : {50.0, 200.0, 1000.0})
        for (const double half_angle_deg : {0.1, 1.0, 10.0, 60.0})
            for (const double frequency_hz : {0.1, 1.0, 5.0, 20.0}) {
                if (frequency_hz > sampling_hz / 10) continue;
                const Cone cone{half_angle_deg, frequency_hz, sampling_hz};
                const double window = drift_deg_h("window-10", cone, 60);
                EXPECT_LE(window, std::max(drift_deg_h("previous", cone, 60), 1e-8))
                    << half_angle_deg << " deg, " << frequency_hz << " Hz at " << sampling_hz << " Hz";
            }
}

// Runs paper 003's motion for 120 s with body increments rounded to a quantum. @returns the angle error [rad].
template <class Quantise>
double quantised_error(const Quantise& quantise)
{
    const PaperMotion motion(0.084, 0.05);
    Propagator stream(make_update("window-10").value(), motion.attitude(0));
    for (int row = 0; row < 1200; ++row) stream.add({quantise(motion.increment(row * 0.1L, 0.1L)), 0.1});
    return angle_between(stream.attitude(), motion.attitude(120));
}

TEST(QuantisedIncrements, cost_below_a_microradian_while_the_remainder_is_carried)
{
    constexpr double quantum = 0.4848e-6;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Vector3d sent = Eigen::Vector3d::Zero();
    const double carried = quantised_error([&](const Eigen::Vector3d& increment) -> Eigen::Vector3d {
        sum += increment;
        const Eigen::Vector3d whole = (sum / quantum).array().floor() * quantum;
        const Eigen::Vector3d out = whole - sent;
        sent = whole;
        return out;
    });
    EXPECT_LE(carried, 1e-6);

    const double truncated = quantised_error(
        [&](const Eigen::Vector3d& increment) -> Eigen::Vector3d { return (increment / quantum).array().floor() * quantum; });
    EXPECT_GT(truncated, 1e-4);
}

Quaternion run(std::string_view algorithm, const std::vector<Eigen::Vector3d>& increments)
{
    Propagator stream(make_update(algorithm).value(), Quaternion::Identity());
    for (const auto& increment : increments) stream.add({increment, 1});
    return stream.attitude();
}

double squared_difference(const Quaternion& a, const Quaternion& b)
{
    return 4 * (a * b.conjugate()).vec().squaredNorm();
}

// Growth of the variance of the attitude per sample of unit noise: the mean squared effect of one disturbed increment, long after.
double random_walk(std::string_view algorithm, const ClassicConing& motion, double interval_s)
{
    constexpr double disturbance_rad = 1e-6;
    std::vector<Eigen::Vector3d> increments;
    for (int row = 0; row < 90; ++row) increments.push_back(motion.increment(row * static_cast<Wide>(interval_s), interval_s));
    const Quaternion undisturbed = run(algorithm, increments);
    double sum = 0;
    for (std::size_t row = 30; row < 60; ++row)
        for (int axis = 0; axis < 3; ++axis) {
            increments[row][axis] += disturbance_rad;
            sum += squared_difference(run(algorithm, increments), undisturbed);
            increments[row][axis] -= disturbance_rad;
        }
    return sum / (90 * disturbance_rad * disturbance_rad);
}

TEST(AngleRandomWalk, equals_that_of_plain_summation_within_one_percent)
{
    for (const Cone& cone : {Cone{60, 1, 18}, Cone{90, 1, 25.4}, Cone{30, 1, 9.3}, Cone{10, 1, 100}, Cone{1, 5, 100}}) {
        const ClassicConing motion(cone.half_angle_deg, cone.frequency_hz);
        const double turn_rad = motion.increment(0, static_cast<Wide>(1 / cone.sampling_hz)).norm();
        EXPECT_LE(turn_rad, 0.36);
        const double ratio = random_walk("window-10", motion, 1 / cone.sampling_hz) / random_walk("single", motion, 1 / cone.sampling_hz);
        EXPECT_NEAR(std::sqrt(ratio), 1, 0.01) << turn_rad << " rad per sample";
    }
}

// A hand that shakes an array: some Hz, which ten samples at 62.5 Hz resolve, and a fifth of it near 20 Hz, which they do not.
Eigen::Vector3d shaken_rad_s(double t)
{
    constexpr double turn = 2 * std::numbers::pi;
    const Eigen::Vector3d slow(20 * std::sin(turn * 3 * t), 20 * std::cos(turn * 2.5 * t), 10 * std::sin(turn * 4 * t));
    const Eigen::Vector3d fast(4 * std::sin(turn * 21 * t + 1), 4 * std::cos(turn * 19 * t), 4 * std::sin(turn * 23 * t));
    return slow + fast;
}

TEST(WindowUpdate, does_not_extrapolate_the_part_of_a_motion_that_is_too_fast_for_its_samples)
{
    constexpr double interval_s = 0.016;
    constexpr int parts = 400;
    std::vector<Eigen::Vector3d> increments;
    Quaternion truth = Quaternion::Identity();
    for (int row = 0; row < 300; ++row) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int part = 0; part < parts; ++part) {
            const Eigen::Vector3d turned = shaken_rad_s((row + (part + 0.5) / parts) * interval_s) * (interval_s / parts);
            sum += turned;
            truth = (truth * from_rotation_vector(turned)).normalized();
        }
        increments.push_back(sum);
    }
    const double window = std::sqrt(squared_difference(run("window-10", increments), truth));
    const double previous = std::sqrt(squared_difference(run("previous", increments), truth));
    EXPECT_LE(window, 2 * previous) << "previous: " << previous << " rad";
}

// Noise alone on a steady turn, where plain summation is exact: the same noise in both, so that few trials tell.
TEST(AngleRandomWalk, is_not_raised_on_a_steady_turn_with_any_noise)
{
    for (const double turn_rad : {0.0, 0.1, 0.35})
        for (const double sigma_rad : {1e-6, 1e-3, 1e-2}) {
            double window = 0;
            double plain = 0;
            for (std::uint64_t seed = 1; seed <= 40; ++seed) {
                std::mt19937_64 random(seed);
                std::normal_distribution<double> normal(0, sigma_rad);
                std::vector<Eigen::Vector3d> increments(1000);
                for (auto& increment : increments) increment = Eigen::Vector3d(turn_rad + normal(random), normal(random), normal(random));
                const Quaternion truth = from_rotation_vector(Eigen::Vector3d(1000 * turn_rad, 0, 0));
                window += squared_difference(run("window-10", increments), truth);
                plain += squared_difference(run("single", increments), truth);
            }
            EXPECT_NEAR(std::sqrt(window / plain), 1, 0.01) << turn_rad << " rad per sample, noise " << sigma_rad;
        }
}

}  // namespace
}  // namespace quorient::attitude
