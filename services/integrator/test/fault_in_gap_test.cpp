// A lane, detector and integrator, through frames that are lost while an axis fails.

#include "../../test/rig.hpp"
#include "integrator_service.hpp"
#include "detector_service.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <gtest/gtest.h>

namespace quorient::integrator {

namespace {

constexpr double bridged_rad = 1e-5;  // rounding, and the coning in a few lost frames

class FaultInGap : public testing::Test {
protected:
    double error_rad() const { return rotation::angle_between(rig.attitude().attitude, rig.truth().attitude); }

    test::Rig rig;
    test::Rig::Process<detector::DetectorService> detector{rig, rig.system.lanes.front().detector};
    test::Rig::Process<IntegratorService> integrator{rig, rig.system.lanes.front().integrator};
};

TEST_F(FaultInGap, is_isolated_and_leaves_nothing_in_the_attitude)
{
    rig.frames(100, detector, integrator);
    rig.inject("axis=1,kind=bias,value=0.05,start=0.53");
    rig.lose(12);
    rig.frames(50, detector, integrator);
    EXPECT_EQ(rig.attitude().isolated_mask, axis_bit(1));
    EXPECT_LT(error_rad(), bridged_rad);
}

TEST_F(FaultInGap, is_not_suspected_where_there_is_none)
{
    rig.frames(100, detector, integrator);
    rig.lose(12);
    for (int frame = 0; frame < 50; ++frame) {
        rig.frames(1, detector, integrator);
        ASSERT_EQ(rig.verdict().state, octet(VerdictState::healthy));
    }
    EXPECT_LT(error_rad(), bridged_rad);
}

}  // namespace

}  // namespace quorient::integrator
