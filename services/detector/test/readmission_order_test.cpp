// What a detector answers to the order to trust an axis again.

#include "../../test/rig.hpp"
#include "detector_service.hpp"
#include "four_axes/four_axis_detector.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <gtest/gtest.h>

namespace quorient::detector {

namespace {

constexpr AxisMask axis_1 = axis_bit(1);

class ReadmissionOrder : public testing::Test {
protected:
    ReadmissionOrder()
    {
        rig.frames(40, detector);
        rig.inject("axis=1,kind=bias,value=0.05,start=0.2");
        rig.frames(20, detector);
    }

    /// @returns what was answered.
    EventCode order(std::uint64_t request)
    {
        FaultCommand command;
        command.unit = rig.system.unit;
        command.action = octet(CommandAction::readmit);
        command.axes = axis_1;
        command.request = request;
        rig.publish(bus::topics::command, command);
        rig.run(detector);
        return code_of(rig.answers(request).at(0));
    }

    test::Rig rig;
    test::Rig::Process<DetectorService> detector{rig, rig.system.lanes.front().detector};
};

TEST_F(ReadmissionOrder, of_an_axis_that_is_still_wrong_is_refused)
{
    ASSERT_EQ(rig.verdict().isolated_mask, axis_1);
    EXPECT_EQ(order(1), EventCode::command_refused);
    EXPECT_NE(std::string(text_of(rig.answers(1).front().text)).find("still disagrees"), std::string::npos);
    rig.frames(100, detector);
    EXPECT_EQ(rig.verdict().isolated_mask, axis_1);
}

TEST_F(ReadmissionOrder, of_an_axis_that_agrees_again_is_obeyed)
{
    rig.heal();
    rig.frames(fdi::FourAxisDetector::release_frames - 1, detector);
    EXPECT_EQ(order(1), EventCode::command_refused) << "one frame less than it takes";
    rig.frames(1, detector);
    EXPECT_EQ(order(2), EventCode::command_done);
    rig.frames(100, detector);
    EXPECT_EQ(rig.verdict().isolated_mask, 0U);
    EXPECT_EQ(rig.verdict().state, octet(VerdictState::healthy));
}

}  // namespace

}  // namespace quorient::detector
