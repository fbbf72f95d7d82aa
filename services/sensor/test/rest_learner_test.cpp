#include "rest_learner.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace quorient::sensor {
namespace {

using State = RestLearner::State;

constexpr double interval_s = 0.005;
constexpr double degree = 3.14159265358979323846 / 180;
constexpr double noise_rad_s = 0.1 * degree;
constexpr std::array<double, 9> bias_deg_s{0.31, -0.22, 0.45, -0.6, 0.27, 0.38, -0.41, 0.2, 0.55};

/// Three triads, each axis with its bias and noise, for at most so long.
class AtRest : public testing::Test {
protected:
    using Rate = std::function<double(double t, std::size_t axis)>;  // beside bias and noise

    State run(RestLearner& learner, double duration_s, const Rate& rate, AxisMask valid = 0x1FF)
    {
        for (double t = 0; t < duration_s && learner.state() == State::learning; t += interval_s) {
            SensorFrame raw;
            raw.interval_s = interval_s;
            raw.valid_mask = valid;
            for (std::size_t axis = 0; axis < 9; ++axis)
                raw.increment[axis] = interval_s * (bias_deg_s[axis] * degree + noise_rad_s * normal_(random_) + rate(t, axis));
            learner.add(raw);
            ended_s_ = t + interval_s;
        }
        return learner.state();
    }

    static double none(double, std::size_t) { return 0; }

    const std::vector<std::size_t> instruments_{0, 0, 0, 1, 1, 1, 2, 2, 2};
    RestLearner learner_{instruments_, 2};
    double ended_s_ = 0;

private:
    std::mt19937_64 random_{5};
    std::normal_distribution<double> normal_;
};

TEST_F(AtRest, biases_and_noise_are_learned_in_the_time_that_is_wanted)
{
    ASSERT_EQ(run(learner_, 10, none), State::rested);
    EXPECT_NEAR(ended_s_, 2, 5 * interval_s);
    EXPECT_EQ(learner_.learned(), 0x1FFU);
    for (std::size_t axis = 0; axis < 9; ++axis) {
        EXPECT_NEAR(learner_.bias_rad_s(axis), bias_deg_s[axis] * degree, 5 * noise_rad_s / std::sqrt(400.0)) << axis;
        EXPECT_NEAR(learner_.sigma_rad(axis), noise_rad_s * interval_s, 0.15 * noise_rad_s * interval_s) << axis;
    }
}

TEST_F(AtRest, nothing_is_learned_in_motion)
{
    const auto turning = [](double t, std::size_t axis) { return 0.5 * std::sin(5 * t + static_cast<double>(axis % 3)); };
    EXPECT_EQ(run(learner_, 10, turning), State::moving);
    EXPECT_LT(ended_s_, 0.51) << "frames must not wait for a rest that is not there";
    EXPECT_EQ(learner_.learned(), 0U);

    RestLearner steady(instruments_, 2);
    EXPECT_EQ(run(steady, 10, [](double, std::size_t) { return 6 * degree; }), State::moving) << "a steady turn is quiet, but no rest";

    RestLearner later(instruments_, 2);
    EXPECT_EQ(run(later, 10, [](double t, std::size_t) { return t < 1.2 ? 0.0 : 2.5 * degree; }), State::moving)
        << "a slow turn that begins meanwhile";
    EXPECT_EQ(later.learned(), 0U);
}

TEST_F(AtRest, one_faulty_instrument_hides_no_rest_and_is_not_learned_where_it_is_beyond_its_class)
{
    const auto faulty = [](double, std::size_t axis) { return axis == 7 ? 20 * degree : 0.0; };
    ASSERT_EQ(run(learner_, 10, faulty), State::rested);
    EXPECT_EQ(learner_.learned(), 0x1FFU & ~(1U << 7U));
}

TEST_F(AtRest, an_instrument_without_data_stays_unknown)
{
    ASSERT_EQ(run(learner_, 10, none, 0x1FFU & ~0b111000U), State::rested);
    EXPECT_EQ(learner_.learned(), 0x1FFU & ~0b111000U);
}

TEST_F(AtRest, nothing_is_awaited_where_no_rest_is_wanted)
{
    EXPECT_EQ(RestLearner(instruments_, 0).state(), State::moving);
}

}  // namespace
}  // namespace quorient::sensor
