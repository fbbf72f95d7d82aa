// An order to reset the attitude holds as of one frame, and is answered once, whatever becomes of that frame.

#include "../../test/rig.hpp"
#include "integrator_service.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <gmock/gmock.h>
#include <cmath>

namespace quorient::integrator {

namespace {

using test::Rig;

const std::array<double, 4> half_turn{0, 0, 0, 1};

class ResetOrder : public testing::Test {
protected:
    ResetOrder() : integrator(rig, rig.system.lanes.front().integrator) { rig.frames(20, integrator); }

    void order(std::uint64_t request, std::uint64_t sequence, const std::array<double, 4>& attitude = half_turn)
    {
        FaultCommand command;
        command.unit = rig.system.unit;
        command.action = octet(CommandAction::reset_attitude);
        command.value = static_cast<double>(sequence);
        command.attitude = attitude;
        command.request = request;
        rig.publish(bus::topics::command, command);
        rig.run(integrator);
    }

    std::vector<EventCode> answered(std::uint64_t request) const
    {
        std::vector<EventCode> codes;
        for (const auto& event : rig.answers(request)) codes.push_back(code_of(event));
        return codes;
    }

    std::string said(std::uint64_t request) const { return std::string{text_of(rig.answers(request).back().text)}; }

    std::uint64_t newest() const { return rig.next_sequence() - 1; }

    /// The angle of the last attitude to the one that was ordered, which a frame or so of the demo's motion may have turned on.
    double away_rad() const
    {
        double cosine = 0;
        for (std::size_t i = 0; i < 4; ++i) cosine += rig.attitude().attitude[i] * half_turn[i];
        return 2 * std::acos(std::min(1.0, std::abs(cosine)));
    }

    Rig rig;
    Rig::Process<IntegratorService> integrator;
};

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double few_frames_rad = 0.01;

TEST_F(ResetOrder, about_the_newest_frame_is_done_at_once)
{
    rig.frames(1, integrator);
    order(7, newest());
    EXPECT_THAT(answered(7), ElementsAre(EventCode::command_done));
    rig.frames(2, integrator);
    EXPECT_LT(away_rad(), few_frames_rad);
}

TEST_F(ResetOrder, about_a_frame_that_other_lanes_have_had_already_waits_for_it)
{
    order(7, newest() + 3);
    rig.frames(2, integrator);
    EXPECT_THAT(answered(7), IsEmpty());
    EXPECT_GT(away_rad(), 1.0);
    rig.frames(3, integrator);
    EXPECT_THAT(answered(7), ElementsAre(EventCode::command_done));
    EXPECT_LT(away_rad(), few_frames_rad);
}

TEST_F(ResetOrder, about_a_frame_that_never_comes_is_refused_within_a_second)
{
    order(7, newest() + 3);
    rig.pass_time(990'000'000);
    rig.run(integrator);
    EXPECT_THAT(answered(7), IsEmpty());
    rig.pass_time(20'000'000);
    rig.run(integrator);
    ASSERT_THAT(answered(7), ElementsAre(EventCode::command_refused));
    EXPECT_THAT(said(7), HasSubstr("has not come"));

    rig.frames(10, integrator);
    EXPECT_EQ(answered(7).size(), 1U) << "answered is answered";
    EXPECT_GT(away_rad(), 1.0) << "what was refused is not done later";
}

TEST_F(ResetOrder, that_waits_is_refused_when_a_newer_order_comes)
{
    order(7, newest() + 3);
    order(8, newest() + 4);
    EXPECT_THAT(answered(7), ElementsAre(EventCode::command_refused));
    rig.frames(8, integrator);
    EXPECT_THAT(answered(7), ElementsAre(EventCode::command_refused));
    EXPECT_THAT(answered(8), ElementsAre(EventCode::command_done));
}

TEST_F(ResetOrder, about_no_frame_near_by_or_to_no_attitude_is_refused_at_once)
{
    order(7, newest() + 1'000'000);
    EXPECT_THAT(answered(7), ElementsAre(EventCode::command_refused));
    order(8, newest(), {1, 1, 0, 0});
    EXPECT_THAT(answered(8), ElementsAre(EventCode::command_refused));
    rig.frames(5, integrator);
    EXPECT_GT(away_rad(), 1.0);
}

}  // namespace

}  // namespace quorient::integrator
