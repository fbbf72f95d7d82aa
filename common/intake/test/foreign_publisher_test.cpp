// What a publisher that is not ours may do wrong is named, once, in words that show its author what to change.

#include "four_gyros.hpp"
#include "quorient/intake/frame_intake.hpp"

#include <gmock/gmock.h>
#include <limits>

namespace quorient::intake {

namespace {

using namespace test;
using Fault = FrameIntake::Fault;
using testing::AllOf;
using testing::HasSubstr;

class ForeignPublisher : public testing::Test {
protected:
    static SensorFrame frame(std::uint64_t sequence) { return test::frame(1, sequence); }

    bool passes(const SensorFrame& offered)
    {
        now_ns += interval_ns;
        intake.offer(offered, now_ns);
        bool passed = false;
        while (intake.next()) passed = true;
        return passed;
    }

    std::string said() const { return words_for(intake.complaint()); }

    FrameIntake intake{unit, SensorKind::gyro};
    std::int64_t now_ns = 0;
};

TEST_F(ForeignPublisher, that_does_everything_right_is_told_nothing)
{
    intake.describe(description(1));
    for (std::uint64_t sequence = 0; sequence < 1000; ++sequence) EXPECT_TRUE(passes(frame(sequence)));
    EXPECT_EQ(intake.complaints(), 0U);
    EXPECT_EQ(said(), "");
}

TEST_F(ForeignPublisher, that_never_describes_itself_is_told_so)
{
    for (std::uint64_t sequence = 0; sequence < 99; ++sequence) EXPECT_FALSE(passes(frame(sequence)));
    EXPECT_EQ(intake.complaints(), 0U) << "within half a second a description may still come";
    for (std::uint64_t sequence = 99; sequence < 110; ++sequence) passes(frame(sequence));
    EXPECT_EQ(intake.complaint().fault, Fault::no_description);
    EXPECT_THAT(said(), AllOf(HasSubstr("epoch 1"), HasSubstr("description")));
    EXPECT_EQ(intake.complaints(), 1U) << "once, not with every frame";
}

TEST_F(ForeignPublisher, that_refers_to_a_revision_nobody_described_is_told_which)
{
    intake.describe(description(1));
    for (std::uint64_t sequence = 0; sequence < 110; ++sequence) {
        auto wrong = frame(sequence);
        wrong.description_revision = 9;
        EXPECT_FALSE(passes(wrong));
    }
    EXPECT_EQ(intake.complaint().fault, Fault::unknown_revision);
    EXPECT_THAT(said(), AllOf(HasSubstr("revision 9"), HasSubstr("1 is the newest")));

    intake.describe(description(1, 9));
    EXPECT_TRUE(passes(frame(110)) || intake.counters().accepted > 0) << "and is received as soon as the description comes";
}

TEST_F(ForeignPublisher, that_never_described_itself_does_not_hold_up_the_next_one)
{
    for (std::uint64_t sequence = 0; sequence < 60; ++sequence) EXPECT_FALSE(passes(frame(sequence)));
    now_ns += 200'000'000;
    intake.describe(description(2));
    auto next = frame(0);
    next.epoch = 2;
    EXPECT_TRUE(passes(next));
}

TEST_F(ForeignPublisher, that_counts_again_in_the_same_epoch_is_told_to_choose_a_new_one)
{
    intake.describe(description(1));
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) passes(frame(sequence));
    for (std::uint64_t sequence = 0; sequence < 5; ++sequence) EXPECT_FALSE(passes(frame(sequence)));
    EXPECT_EQ(intake.complaint().fault, Fault::sequence_restart);
    EXPECT_THAT(said(), AllOf(HasSubstr("after 99"), HasSubstr("epoch")));
}

TEST_F(ForeignPublisher, whose_network_turns_single_frames_around_is_not_called_restarted)
{
    intake.describe(description(1));
    for (std::uint64_t sequence = 1; sequence < 100; ++sequence) {
        passes(frame(sequence));
        EXPECT_FALSE(passes(frame(sequence - 1)));
    }
    EXPECT_EQ(intake.complaints(), 0U);
}

TEST_F(ForeignPublisher, with_another_number_of_axes_than_described_is_told_both)
{
    intake.describe(description(1));
    auto wrong = frame(0);
    wrong.axis_count = 5;
    EXPECT_FALSE(passes(wrong));
    EXPECT_THAT(said(), AllOf(HasSubstr("5 axes"), HasSubstr("description 4")));
}

TEST_F(ForeignPublisher, whose_time_stands_still_or_whose_interval_is_none_is_told_the_frame)
{
    intake.describe(description(1));
    EXPECT_TRUE(passes(frame(0)));
    auto wrong = frame(1);
    wrong.sample_time_ns = frame(0).sample_time_ns;
    EXPECT_FALSE(passes(wrong));
    EXPECT_THAT(said(), AllOf(HasSubstr("frame 1"), HasSubstr("sample time")));
    wrong = frame(2);
    wrong.interval_s = -0.005;
    EXPECT_FALSE(passes(wrong));
    EXPECT_THAT(said(), AllOf(HasSubstr("frame 2"), HasSubstr("interval")));
}

TEST_F(ForeignPublisher, with_a_value_that_is_no_number_is_told_the_axis)
{
    intake.describe(description(1));
    auto wrong = frame(0);
    wrong.increment[2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(passes(wrong)) << "the other axes are good";
    EXPECT_THAT(said(), HasSubstr("axis 2"));
}

TEST_F(ForeignPublisher, whose_description_is_none_is_told_what_is_wrong_with_it)
{
    auto wrong = description(1);
    wrong.axis_count = 2;
    intake.describe(wrong);
    EXPECT_EQ(intake.complaint().fault, Fault::description);
    EXPECT_THAT(said(), HasSubstr("3 to 24 axes"));
    for (std::uint64_t sequence = 0; sequence < 110; ++sequence) EXPECT_FALSE(passes(frame(sequence)));
    EXPECT_EQ(intake.complaint().fault, Fault::description) << "that is why its frames have none";
}

}  // namespace

}  // namespace quorient::intake
