#include "../src/classic_update.hpp"
#include "coning.hpp"
#include "reference_cases.hpp"

#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace quorient::attitude {
namespace {

using namespace testing;

std::vector<std::string> every_algorithm()
{
    std::vector<std::string> names{"single", "previous", "two-sample", "three-sample", "three-sample-miller", "four-sample"};
    for (const char* family : {"block-", "window-"})
        for (std::size_t order = 1; order <= longest_memory; ++order) names.push_back(family + std::to_string(order));
    return names;
}

Propagator propagator(std::string_view name, const Quaternion& initial = Quaternion::Identity())
{
    return Propagator(make_update(name).value(), initial);
}

TEST(Update, refuses_names_it_does_not_know_and_lists_those_it_knows)
{
    for (const char* name :
         {"", "window", "window-", "window-0", "window-13", "window-8x", "block--1", "triple", "window-99999999999999999999"}) {
        const auto made = make_update(name);
        ASSERT_FALSE(made.has_value()) << name;
        EXPECT_NE(made.error().find("window-N"), std::string::npos) << made.error();
    }
    for (const auto& name : every_algorithm()) EXPECT_TRUE(make_update(name).has_value()) << name;
}

TEST(Update, names_equation_and_source_of_every_algorithm)
{
    for (const auto& entry : update_catalogue()) {
        EXPECT_FALSE(entry.equation.empty()) << entry.name;
        EXPECT_FALSE(entry.source.empty()) << entry.name;
    }
}

TEST(Update, agrees_with_the_worked_rotation_vectors)
{
    const auto cases = test::reference_cases("rotation_vector");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& one : *cases) {
        std::vector<Sample> block;
        for (const auto& row : one["input"]["increments"])
            block.push_back({Eigen::Vector3d(row[0].get<double>(), row[1].get<double>(), row[2].get<double>()), 1});
        const Eigen::Vector3d phi = rotation_vector(block, ClassicRule::four_sample);
        const Quaternion dq = from_rotation_vector(phi);
        const double tolerance = one["tol"]["abs"];
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(phi[i], one["expected"]["phi"][static_cast<std::size_t>(i)].get<double>(), tolerance) << one["id"];
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(to_array(dq)[i], one["expected"]["dq"][i].get<double>(), tolerance) << one["id"];
    }
}

TEST(Update, agrees_with_the_worked_drifts)
{
    const auto cases = test::reference_cases("coning_drift");
    QUORIENT_SKIP_WITHOUT(cases);
    const std::array<std::string, 5> algorithm{"", "single", "two-sample", "three-sample", "four-sample"};
    for (const auto& one : *cases) {
        const auto& input = one["input"];
        const std::string& name = algorithm.at(input["samples"].get<std::size_t>());
        const bool classic = input["model"].get<std::string>().starts_with("classic");
        const double error = classic ? error_after(name, ClassicConing(1, 5), input["h"], input["T"])
                                     : error_after(name, PaperMotion(0.084, 0.05), input["h"], input["T"]);
        const double expected = one["expected"]["angle_error_rad"];
        EXPECT_NEAR(error, expected, one["tol"]["abs"].get<double>() + one["tol"]["rel"].get<double>() * expected) << one["id"];
    }
}

// The motion that all drifts on it are measured against.
TEST(PaperMotion, has_the_increments_and_the_turn_of_the_worked_kinematics)
{
    const auto cases = test::reference_cases("kinematics");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& one : *cases) {
        const auto& input = one["input"];
        const PaperMotion motion(input["k2"], input["k3"]);
        const Eigen::Vector3d increment = motion.increment(input["t"].get<double>(), input["h"].get<double>());
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(increment[i], one["expected"]["increment_t_to_t_plus_h"][static_cast<std::size_t>(i)].get<double>(), 1e-12)
                << one["id"];
        const Quaternion start(0, 0, input["mu"], input["nu"]);
        const auto& q = one["expected"]["q"];
        const Quaternion expected(q[0], q[1], q[2], q[3]);
        const bool from_start = angle_between(start * motion.attitude(input["t"].get<double>()), expected) < 1e-12;
        const Quaternion other(input["mu"], 0, 0, input["nu"]);
        EXPECT_TRUE(from_start || angle_between(other * motion.attitude(input["t"].get<double>()), expected) < 1e-12) << one["id"];
    }
}

TEST(Update, is_exact_on_a_rotation_about_a_fixed_axis)
{
    const Eigen::Vector3d rate_rad_s(0.3, -1.1, 0.7);
    for (const auto& name : every_algorithm()) {
        auto stream = propagator(name);
        for (int row = 1; row <= 40; ++row) {
            const auto& q = stream.add({rate_rad_s * 0.01, 0.01});
            EXPECT_LT(angle_between(q, from_rotation_vector(rate_rad_s * 0.01 * row)), 1e-14) << name << ", row " << row;
        }
    }
}

TEST(Update, follows_smooth_motion_at_every_row_not_only_at_full_blocks)
{
    const ClassicConing motion(10, 1);
    for (const auto& name : every_algorithm()) {
        if (name.ends_with("-1")) continue;  // without a second sample nothing is known of coning, as with `single`
        const double allowed = name == "single" ? 2e-4 : 3e-6;
        auto stream = propagator(name, motion.attitude(0));
        for (int row = 0; row < 100; ++row) {
            const auto& q = stream.add({motion.increment(row * 0.01L, 0.01L), 0.01});
            EXPECT_LT(angle_between(q, motion.attitude((row + 1) * 0.01L)), allowed) << name << ", row " << row;
        }
    }
}

TEST(Update, keeps_the_norm_at_one)
{
    const ClassicConing motion(40, 3);
    for (const auto& name : every_algorithm()) {
        auto stream = propagator(name, motion.attitude(0));
        for (int row = 0; row < 5000; ++row) {
            const auto& q = stream.add({motion.increment(row * 0.01L, 0.01L), 0.01});
            ASSERT_NEAR(q.norm(), 1, 5e-16) << name << ", row " << row;
        }
    }
}

TEST(Update, survives_zeros_denormals_and_rotations_beyond_pi)
{
    const std::array<Eigen::Vector3d, 9> nasty{
        Eigen::Vector3d(0, 0, 0),        Eigen::Vector3d(5e-324, 0, 0), Eigen::Vector3d(1e-308, -1e-308, 1e-310),
        Eigen::Vector3d(3.2, 0, 0),      Eigen::Vector3d(-4, 5, 6),     Eigen::Vector3d(0, 0, 0),
        Eigen::Vector3d(1e6, -1e6, 1e6), Eigen::Vector3d(1e-200, 0, 1), Eigen::Vector3d(0, -0.0, 0)};
    std::mt19937_64 random(7);
    for (const auto& name : every_algorithm()) {
        auto stream = propagator(name);
        for (int row = 0; row < 300; ++row) {
            const double interval_s = random() % 5 == 0 ? 1e-9 : 0.01;
            const auto& q = stream.add({nasty[random() % nasty.size()], interval_s});
            ASSERT_TRUE(q.coeffs().allFinite()) << name << ", row " << row;
            ASSERT_NEAR(q.norm(), 1, 1e-12) << name << ", row " << row;
        }
    }
}

TEST(Update, does_not_move_on_zero_increments)
{
    const Quaternion start = from_rotation_vector({0.3, 0.2, -0.7});
    for (const auto& name : every_algorithm()) {
        auto stream = propagator(name, start);
        for (int row = 0; row < 50; ++row) EXPECT_LT(angle_between(stream.add({Eigen::Vector3d::Zero(), 0.01}), start), 4e-16) << name;
    }
}

TEST(WindowUpdate, is_right_from_the_first_rows_once_the_window_is_full)
{
    const ClassicConing motion(10, 1);
    auto stream = propagator("window-10", motion.attitude(0));
    for (int row = 0; row < 10; ++row) stream.add({motion.increment(row * 0.01L, 0.01L), 0.01});
    EXPECT_LT(angle_between(stream.attitude(), motion.attitude(0.1L)), 1e-14);

    // A window that merely grows keeps the errors of its first rows for ever.
    auto growing = propagator("window-2", motion.attitude(0));
    for (int row = 0; row < 10; ++row) growing.add({motion.increment(row * 0.01L, 0.01L), 0.01});
    EXPECT_GT(angle_between(growing.attitude(), motion.attitude(0.1L)), 1e-9);
}

double drift_with_intervals(std::string_view name, const ClassicConing& motion, const std::vector<double>& intervals)
{
    auto stream = propagator(name, motion.attitude(0));
    Wide time_s = 0;
    for (const double h : intervals) {
        stream.add({motion.increment(time_s, h), h});
        time_s += static_cast<Wide>(h);
    }
    return angle_between(stream.attitude(), motion.attitude(time_s));
}

TEST(WindowUpdate, takes_unequal_intervals)
{
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> jitter(0.8, 1.2);
    std::vector<double> intervals(2000);
    for (double& h : intervals) h = 0.01 * jitter(random);
    const ClassicConing motion(10, 1);
    EXPECT_LT(drift_with_intervals("window-10", motion, intervals), 1e-11);
    EXPECT_GT(drift_with_intervals("previous", motion, intervals), 1e-8);
}

TEST(WindowUpdate, stays_exact_when_the_interval_changes)
{
    const ClassicConing motion(10, 1);
    for (const double factor : {0.05, 0.1, 0.5, 2.0, 3.0}) {
        std::vector<double> intervals(300, 0.004);
        intervals.resize(600, 0.004 * factor);
        EXPECT_LT(drift_with_intervals("window-10", motion, intervals), 1e-9) << "factor " << factor;
    }
}

TEST(WindowUpdate, goes_on_after_one_long_interval)
{
    const ClassicConing motion(10, 1);
    for (const double gap : {2.0, 3.0, 5.0, 10.0}) {
        std::vector<double> intervals(300, 0.005);
        intervals[150] *= gap;
        const double without = angle_between(from_rotation_vector(motion.increment(0.75L, 0.005L * gap)),
                                             motion.attitude(0.75L).conjugate() * motion.attitude(0.75L + 0.005L * gap));
        EXPECT_LT(drift_with_intervals("window-10", motion, intervals), 0.1 * without) << "gap of " << gap;
    }
}

TEST(WindowUpdate, is_no_worse_than_one_twelfth_where_the_motion_is_too_fast_for_it)
{
    for (const double frequency_hz : {17.0, 20.0, 25.0, 30.0, 40.0, 45.0}) {
        const ClassicConing motion(5, frequency_hz);
        EXPECT_LE(error_after("window-10", motion, 0.01, 2), 1.1 * error_after("previous", motion, 0.01, 2)) << frequency_hz << " Hz";
    }
}

}  // namespace
}  // namespace quorient::attitude
