// A lane that does not keep up: what it gives out, and what it does not lose.

#include "../../test/rig.hpp"
#include "detector_service.hpp"
#include "integrator_service.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/rotation/quaternion.hpp"
#include "quorient/runtime/shedding.hpp"

#include <gtest/gtest.h>
#include <string>

namespace quorient::integrator {

namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr double exact_rad = 1e-6;  // as without an overload: the axes' noise and quantisation

class AnOverloadedLane : public testing::Test {
protected:
    void frames(unsigned count) { rig.frames(count, detector, integrator); }
    double error_rad() const { return rotation::angle_between(rig.attitude().attitude, rig.truth().attitude); }

    /// A voter's output. @param ahead  so many frames ahead of the newest one
    void vote(std::int64_t age_ns, std::uint64_t ahead = 0)
    {
        VotedAttitude voted;
        voted.unit = rig.system.unit;
        voted.epoch = test::Rig::first_epoch;
        voted.sequence = rig.next_sequence() - 1 + ahead;
        voted.attitude = rig.attitude().attitude;
        voted.stamp_ns[static_cast<std::size_t>(Hop::sensor)] = rig.now_ns() - age_ns;
        rig.publish(bus::topics::voter_output, voted);
    }

    void vote_for(unsigned count, std::int64_t age_ns)
    {
        for (unsigned i = 0; i < count; ++i) {
            frames(1);
            vote(age_ns);
        }
    }

    /// Frames come late for so long that it is no standstill any more.
    void overload()
    {
        frames(100);
        rig.delay_frames(100 * ms);
        frames(200);
    }

    test::Rig rig;
    test::Rig::Process<detector::DetectorService> detector{rig, rig.system.lanes.front().detector};
    test::Rig::Process<IntegratorService> integrator{rig, rig.system.lanes.front().integrator};
};

TEST_F(AnOverloadedLane, gives_out_one_frame_in_four)
{
    overload();
    const auto verdicts = rig.verdicts();
    const auto attitudes = rig.attitudes();
    frames(400);
    EXPECT_EQ(rig.verdicts() - verdicts, 100U);
    EXPECT_EQ(rig.attitudes() - attitudes, 100U);
    EXPECT_EQ(rig.attitude().sequence % runtime::Pace::kept_of, 0U);
    EXPECT_EQ(rig.verdict().sequence, rig.attitude().sequence);
}

TEST_F(AnOverloadedLane, gives_out_every_frame_after_a_standstill)
{
    frames(100);
    rig.delay_frames(300 * ms);
    frames(60);
    rig.delay_frames(0);
    frames(100);
    EXPECT_EQ(rig.verdicts(), 260U);
    EXPECT_EQ(rig.attitudes(), 260U);
    EXPECT_TRUE(rig.events(EventCode::overloaded).empty());
}

TEST_F(AnOverloadedLane, loses_no_rotation)
{
    overload();
    frames(1001 - static_cast<unsigned>(rig.next_sequence() % 4));  // the newest frame is one that is given out
    ASSERT_EQ(rig.attitude().sequence + 1, rig.next_sequence());
    EXPECT_LT(error_rad(), exact_rad);
    EXPECT_EQ(rig.attitude().bridged, 0);
}

TEST_F(AnOverloadedLane, isolates_a_fault_and_leaves_nothing_of_it_in_the_attitude)
{
    overload();
    rig.inject("axis=1,kind=bias,value=0.05,start=2");
    frames(401 - static_cast<unsigned>(rig.next_sequence() % 4));
    ASSERT_EQ(rig.attitude().sequence + 1, rig.next_sequence());
    EXPECT_EQ(rig.verdict().isolated_mask, axis_bit(1));
    EXPECT_EQ(rig.attitude().isolated_mask, axis_bit(1));
    EXPECT_LT(error_rad(), exact_rad);
}

TEST_F(AnOverloadedLane, gives_out_a_suspicion_of_one_frame_whichever_it_is)
{
    overload();
    for (int onset = 0; onset < 4; ++onset) {
        const auto suspicions = rig.suspicions();
        const double start_s = 0.005 * static_cast<double>(rig.next_sequence() + 20 + static_cast<unsigned>(onset));
        rig.inject("axis=1,kind=bias,value=0.05,start=" + std::to_string(start_s - 0.001) + ",end=" + std::to_string(start_s + 0.004));
        frames(80);
        EXPECT_GT(rig.suspicions(), suspicions) << "onset " << onset;
        rig.heal();
    }
}

TEST_F(AnOverloadedLane, says_when_it_begins_and_ends_and_how_much_was_left_out)
{
    overload();
    auto events = rig.events(EventCode::overloaded);
    ASSERT_EQ(events.size(), 2U) << "one of the detector, one of the integrator";
    for (const auto& event : events) {
        EXPECT_EQ(event.severity, octet(Severity::warning_high));
        EXPECT_NE(text_of(event.text).find("OVERLOADED: frames are 100 ms old"), std::string::npos) << text_of(event.text);
    }
    rig.delay_frames(0);
    frames(1600);  // the next trial, and as long as it lasts
    events = rig.events(EventCode::overloaded);
    ASSERT_EQ(events.size(), 4U);
    for (std::size_t i = 2; i < 4; ++i) {
        EXPECT_EQ(events[i].severity, octet(Severity::info));
        EXPECT_NE(text_of(events[i].text).find("keeps up again: "), std::string::npos) << text_of(events[i].text);
    }
    const auto verdicts = rig.verdicts();
    frames(100);
    EXPECT_EQ(rig.verdicts() - verdicts, 100U);
}

TEST_F(AnOverloadedLane, also_sheds_where_the_voted_attitude_comes_late)
{
    vote_for(100, 0);
    vote_for(200, 100 * ms);
    const auto attitudes = rig.attitudes();
    vote_for(100, 100 * ms);
    EXPECT_EQ(rig.attitudes() - attitudes, 25U);
    EXPECT_LT(error_rad(), 1e-1);
}

TEST_F(AnOverloadedLane, heeds_no_voted_attitude_of_a_frame_that_it_has_not_received)
{
    vote_for(100, 0);
    vote(0, 500);
    vote_for(200, 100 * ms);
    const auto attitudes = rig.attitudes();
    vote_for(100, 100 * ms);
    EXPECT_EQ(rig.attitudes() - attitudes, 25U) << "those of received frames, which are late, still count";
}

}  // namespace

}  // namespace quorient::integrator
