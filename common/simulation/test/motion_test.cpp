#include "quorient/simulation/motion.hpp"

#include "reference_cases.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <numbers>

namespace quorient::simulation {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180.0;

struct NamedMotion {
    std::string name;
    Motion motion;
};

std::vector<NamedMotion> every_motion()
{
    return {{"rest", Rest{}},
            {"turn", Turn{{0.3, -1.2, 2.5}}},
            {"coning", Coning{}},
            {"coning without k3", Coning{0.4, 0.0, 0.6, 0.8}},
            {"classic coning", ClassicConing{10 * degree, 2.0}},
            {"random", RandomMotion(2.0, 1.5, 7)}};
}

double angle_between(const Quaterniond& a, const Quaterniond& b)
{
    return 2.0 * (a.conjugate() * b).vec().norm();
}

TEST(Motion, has_the_rate_that_its_attitude_turns_with)
{
    for (const auto& [name, motion] : every_motion()) {
        for (const double t : {0.0, 0.7, 13.1, 250.3}) {
            const double d = 1e-4;  // five-point derivative: error of order d^4
            const auto q = [&](double offset) { return motion.attitude(t + offset).coeffs(); };
            const Eigen::Vector4d slope = (8.0 * (q(d) - q(-d)) - (q(2 * d) - q(-2 * d))) / (12.0 * d);
            const Vector3d rate = 2.0 * (motion.attitude(t).conjugate() * Quaterniond(slope)).vec();
            EXPECT_LT((rate - motion.rate(t)).norm(), 2e-9) << name << " at " << t << " s";
        }
    }
}

TEST(Motion, has_increments_that_are_the_integral_of_its_rate)
{
    for (const auto& [name, motion] : every_motion()) {
        const double begin = 3.21;
        const double h = 0.1;
        Vector3d sum = Vector3d::Zero();  // composite Simpson rule, independent of the library's quadrature
        const int cells = 2000;
        for (int i = 0; i < cells; ++i) {
            const double a = begin + h * i / cells;
            const double b = begin + h * (i + 1) / cells;
            sum += (b - a) / 6.0 * (motion.rate(a) + 4.0 * motion.rate((a + b) / 2.0) + motion.rate(b));
        }
        EXPECT_LT((sum - motion.increment(begin, h)).norm(), 3e-14) << name;
    }
}

TEST(Motion, has_increments_that_add_up)
{
    for (const auto& [name, motion] : every_motion()) {
        const Vector3d whole = motion.increment(5.0, 0.2);
        const Vector3d halves = motion.increment(5.0, 0.1) + motion.increment(5.1, 0.1);
        EXPECT_LT((whole - halves).norm(), 3e-15) << name;  // 63 rad of phase are known to 1.4e-14 only
    }
}

TEST(Motion, keeps_a_unit_quaternion)
{
    for (const auto& [name, motion] : every_motion())
        for (const double t : {0.0, 1.0, 1000.0}) EXPECT_NEAR(motion.attitude(t).norm(), 1.0, 1e-15) << name;
}

TEST(Motion, agrees_with_the_worked_cases_of_paper_003)
{
    const auto cases = test::reference_cases("kinematics");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& one : *cases) {
        const auto& in = one["input"];
        const auto& expected = one["expected"];
        const double tolerance = one["tol"]["abs"];
        const Motion motion = Coning{in["k2"], in["k3"], in["mu"], in["nu"]};
        const Quaterniond q = motion.attitude(in["t"]);
        const std::array<double, 4> components{q.w(), q.x(), q.y(), q.z()};
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(components[i], expected["q"][i].get<double>(), tolerance) << one["id"];
        const Vector3d rate = motion.rate(in["t"]);
        const Vector3d increment = motion.increment(in["t"], in["h"]);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            EXPECT_NEAR(rate(row), expected["omega"][i].get<double>(), tolerance) << one["id"];
            EXPECT_NEAR(increment(row), expected["increment_t_to_t_plus_h"][i].get<double>(), tolerance) << one["id"];
        }
    }
}

/// Integrates increments with one rotation vector per N samples, so that the motions can be compared with published drifts.
double drift(const Motion& motion, double h, double duration, int samples)
{
    Quaterniond q = motion.attitude(0.0);
    const int updates = static_cast<int>(std::lround(duration / (h * samples)));
    for (int update = 0; update < updates; ++update) {
        const double t = h * samples * update;
        Vector3d rotation = motion.increment(t, h);
        if (samples == 2) {
            const Vector3d second = motion.increment(t + h, h);
            rotation = (rotation + second + 2.0 / 3.0 * rotation.cross(second)).eval();
        }
        q = q * Quaterniond(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
    }
    return angle_between(motion.attitude(duration), q);
}

TEST(Motion, makes_simple_algorithms_drift_as_published)
{
    const auto cases = test::reference_cases("coning_drift");
    QUORIENT_SKIP_WITHOUT(cases);
    for (const auto& one : *cases) {
        const auto& in = one["input"];
        const std::string model = in["model"];
        const Motion motion =
            model.starts_with("classic") ? Motion(ClassicConing{1 * degree, 5.0}) : Motion(Coning{0.084, 0.05, -0.6, 0.8});
        const double expected = one["expected"]["angle_error_rad"];
        EXPECT_NEAR(drift(motion, in["h"], in["T"], in["samples"]), expected, 1e-3 * expected + 1e-11) << one["id"];
    }
}

TEST(Motion, random_has_the_stated_rate_and_depends_on_the_seed_alone)
{
    const double rms_rad_s = 0.6;
    const Motion motion = RandomMotion(3.0, rms_rad_s, 42);
    double squares = 0;
    const int samples = 40000;
    for (int i = 0; i < samples; ++i) squares += motion.rate(0.05 * i).squaredNorm() / 3.0;
    EXPECT_NEAR(std::sqrt(squares / samples), rms_rad_s, 0.05 * rms_rad_s);

    EXPECT_EQ(motion.rate(12.3), Motion(RandomMotion(3.0, rms_rad_s, 42)).rate(12.3));
    EXPECT_NE(motion.rate(12.3), Motion(RandomMotion(3.0, rms_rad_s, 43)).rate(12.3));
}

TEST(Motion, feels_gravity_in_the_body_frame)
{
    const double h = 0.01;
    EXPECT_LT((Motion(Rest{}).velocity_increment(3.0, h) - Vector3d(0, 0, 9.80665 * h)).norm(), 1e-15);

    const double rate = 0.5;
    const Motion roll = Turn{{rate, 0, 0}};
    const double begin = 1.0;
    const double end = begin + h;  // f_B = g (0, sin phi, cos phi) at roll angle phi
    const Vector3d expected(0, 9.80665 / rate * (std::cos(rate * begin) - std::cos(rate * end)),
                            9.80665 / rate * (std::sin(rate * end) - std::sin(rate * begin)));
    EXPECT_LT((roll.velocity_increment(begin, h) - expected).norm(), 1e-14);
}

TEST(Motion, refuses_parameters_that_no_body_can_follow)
{
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_NE(checked(Coning{0.1, 0.1, 0.6, 0.7}).error().find("mu^2 + nu^2"), std::string::npos);
    EXPECT_FALSE(checked(Coning{inf, 0.1, 0.6, 0.8}));
    EXPECT_FALSE(checked(ClassicConing{-0.1, 1.0}));
    EXPECT_FALSE(checked(ClassicConing{0.1, -1.0}));
    EXPECT_FALSE(checked(Turn{{0, inf, 0}}));
    EXPECT_FALSE(checked(RandomMotion(0.0, 1.0, 1)));
    EXPECT_FALSE(checked(RandomMotion(inf, 1.0, 1)));
    EXPECT_TRUE(checked(Coning{0.1, 0.1, 0.6, 0.8}));
    EXPECT_TRUE(checked(ClassicConing{0.1, 1.0}));
    EXPECT_TRUE(checked(Turn{}));
    EXPECT_TRUE(checked(RandomMotion(5.0, 1.0, 1)));
}

}  // namespace
}  // namespace quorient::simulation
