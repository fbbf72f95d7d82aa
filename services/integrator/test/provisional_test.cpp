// A verdict that leaves an axis out for a time, through the integrator process.

#include "../../test/rig.hpp"
#include "integrator_service.hpp"
#include "quorient/messages/left_out.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <gtest/gtest.h>

namespace quorient::integrator {
namespace {

constexpr AxisMask axis_1 = 0b0010;
constexpr double rounding_rad = 2e-6;  // and the sensors' resolution

class Provisional : public testing::Test {
protected:
    /// The newest frame's verdict.
    void judge(VerdictState state, AxisMask left_out = 0, std::uint64_t from = 0)
    {
        FaultVerdict verdict;
        verdict.unit = rig.system.unit;
        verdict.detector = rig.system.lanes.front().integrator.detector;
        verdict.epoch = rig.truth().epoch;
        verdict.sequence = rig.truth().sequence;
        verdict.state = octet(state);
        verdict.excluded_from.exclude(left_out, from);
        rig.publish(bus::topics::verdict, verdict);
        rig.run(integrator);
    }

    double error_rad() const { return rotation::angle_between(rig.attitude().attitude, rig.truth().attitude); }

    test::Rig rig;
    test::Rig::Process<IntegratorService> integrator{rig, rig.system.lanes.front().integrator};
};

TEST_F(Provisional, exclusion_takes_a_disturbance_out_of_the_attitude_and_ends_without_a_step)
{
    for (int i = 0; i < 100; ++i) {
        rig.frame(integrator);
        judge(VerdictState::healthy);
    }
    const std::uint64_t onset = rig.next_sequence();
    rig.inject("axis=1,kind=bias,value=0.05,start=0.5,end=0.52");
    for (int i = 0; i < 4; ++i) {
        rig.frame(integrator);
        judge(VerdictState::healthy);
    }
    EXPECT_GT(error_rad(), 1e-4) << "the disturbance is in the attitude";
    for (int i = 0; i < 60; ++i) {
        rig.frame(integrator);
        judge(VerdictState::provisional, axis_1, onset);
        ASSERT_EQ(rig.attitude().isolated_mask, 0U);
        ASSERT_EQ(left_out_mask(rig.attitude()), axis_1);
        ASSERT_FALSE(has_axis(rig.attitude().used_mask, 1));
        ASSERT_LT(error_rad(), rounding_rad) << i;
    }
    EXPECT_EQ(rig.attitude().reset_counter, 1U);
    for (int i = 0; i < 60; ++i) {
        rig.frame(integrator);
        judge(VerdictState::healthy);
        ASSERT_EQ(left_out_mask(rig.attitude()), 0U);
        ASSERT_TRUE(has_axis(rig.attitude().used_mask, 1));
        ASSERT_LT(error_rad(), rounding_rad) << i;
    }
    EXPECT_EQ(rig.attitude().reset_counter, 1U) << "the return is no reset";
}

}  // namespace
}  // namespace quorient::integrator
