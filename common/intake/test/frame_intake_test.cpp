#include "four_gyros.hpp"
#include "quorient/intake/frame_intake.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace quorient::intake {

namespace {

using namespace test;

constexpr std::int64_t second_ns = 1'000'000'000;

ClusterDescription ranged(std::uint64_t epoch)
{
    ClusterDescription described = description(epoch);
    described.range.fill(10);
    return described;
}

class Intake : public testing::Test {
protected:
    Intake() : intake(unit, SensorKind::gyro) { intake.describe(ranged(1)); }

    /// Offers at the time that the sequence stands for. @returns whether it came through.
    bool passes(const SensorFrame& offered, std::int64_t now_ns)
    {
        intake.offer(offered, now_ns);
        const auto* accepted = intake.next();
        if (accepted) last = *accepted;
        return accepted != nullptr;
    }
    bool passes(const SensorFrame& offered) { return passes(offered, static_cast<std::int64_t>(offered.sequence) * interval_ns); }

    FrameIntake intake;
    FrameIntake::Accepted last;
};

TEST_F(Intake, passes_what_is_new_and_in_order)
{
    for (std::uint64_t sequence = 0; sequence < 10; ++sequence) EXPECT_TRUE(passes(frame(1, sequence)));
    EXPECT_EQ(intake.counters().accepted, 10U);
    EXPECT_EQ(intake.counters().gaps, 0U);
    EXPECT_EQ(intake.counters().duplicates, 0U);
}

TEST_F(Intake, takes_two_channels_of_a_vessel_and_refuses_two_axes_in_space)
{
    ClusterDescription two = ranged(1);
    two.axis_count = 2;
    EXPECT_NE(FrameIntake::problem_of(two), nullptr);
    two.kind = octet(SensorKind::vessel_rates);
    EXPECT_EQ(FrameIntake::problem_of(two), nullptr);
    two.axis_count = 0;
    EXPECT_NE(FrameIntake::problem_of(two), nullptr);
}

TEST_F(Intake, counts_duplicates_late_frames_and_gaps)
{
    EXPECT_TRUE(passes(frame(1, 0)));
    EXPECT_TRUE(passes(frame(1, 5)));
    EXPECT_FALSE(passes(frame(1, 5)));
    EXPECT_FALSE(passes(frame(1, 2)));
    EXPECT_EQ(intake.counters().gaps, 4U);
    EXPECT_EQ(intake.counters().duplicates, 1U);
    EXPECT_EQ(intake.counters().late, 1U);
}

TEST_F(Intake, ignores_another_unit_and_another_kind)
{
    auto other = frame(1, 0);
    other.unit = unit + 1;
    EXPECT_FALSE(intake.offer(other, 0));
    other = frame(1, 0);
    other.kind = octet(SensorKind::accelerometer);
    EXPECT_FALSE(intake.offer(other, 0));
    EXPECT_EQ(intake.counters().foreign, 0U);
}

TEST_F(Intake, holds_a_second_publisher_off_while_the_first_one_sends)
{
    intake.describe(ranged(2));
    EXPECT_TRUE(passes(frame(1, 0), 0));
    EXPECT_FALSE(passes(frame(2, 0), interval_ns));
    EXPECT_TRUE(passes(frame(1, 1), 2 * interval_ns));
    EXPECT_EQ(intake.counters().foreign, 1U);
    EXPECT_EQ(intake.foreign_epoch(), 2U);
}

TEST_F(Intake, accepts_a_newer_epoch_once_the_old_one_is_silent)
{
    intake.describe(ranged(2));
    EXPECT_TRUE(passes(frame(1, 0), 0));
    EXPECT_TRUE(passes(frame(2, 0), second_ns));
    EXPECT_TRUE(last.new_epoch);
    EXPECT_TRUE(last.new_description);
    EXPECT_FALSE(passes(frame(1, 1), second_ns + interval_ns)) << "the old epoch is over";
}

TEST_F(Intake, never_goes_back_to_an_older_epoch)
{
    intake.describe(ranged(2));
    EXPECT_TRUE(passes(frame(2, 0), 0));
    EXPECT_FALSE(passes(frame(1, 0), 10 * second_ns));
}

TEST_F(Intake, keeps_frames_until_their_description_comes)
{
    FrameIntake undescribed{unit, SensorKind::gyro};
    for (std::uint64_t sequence = 0; sequence < 3; ++sequence) undescribed.offer(frame(1, sequence), 0);
    EXPECT_EQ(undescribed.next(), nullptr);
    undescribed.describe(ranged(1));
    for (std::uint64_t sequence = 0; sequence < 3; ++sequence) {
        const auto* accepted = undescribed.next();
        ASSERT_NE(accepted, nullptr);
        EXPECT_EQ(accepted->frame.sequence, sequence);
    }
}

TEST_F(Intake, gives_up_the_oldest_of_more_frames_than_it_can_keep)
{
    FrameIntake undescribed{unit, SensorKind::gyro};
    for (std::uint64_t sequence = 0; sequence < 70; ++sequence) undescribed.offer(frame(1, sequence), 0);
    undescribed.describe(ranged(1));
    EXPECT_EQ(undescribed.next()->frame.sequence, 6U);
    EXPECT_EQ(undescribed.counters().waiting_lost, 6U);
}

TEST_F(Intake, takes_the_valid_bit_from_values_that_are_no_numbers_or_out_of_range)
{
    auto bad = frame(1, 0);
    bad.increment[0] = std::numeric_limits<double>::quiet_NaN();
    bad.increment[2] = std::numeric_limits<double>::infinity();
    bad.increment[3] = 10 * 0.005 * 1.01;
    ASSERT_TRUE(passes(bad));
    EXPECT_EQ(last.frame.valid_mask, axis_bit(1));
    EXPECT_EQ(intake.counters().rejected_values, 3U);
}

TEST_F(Intake, leaves_values_at_the_end_of_their_range_alone)
{
    auto extreme = frame(1, 0);
    extreme.increment[3] = -10 * 0.005;
    ASSERT_TRUE(passes(extreme));
    EXPECT_EQ(last.frame.valid_mask, all_axes(4));
}

TEST_F(Intake, refuses_frames_with_a_wrong_axis_count_interval_or_time)
{
    auto bad = frame(1, 0);
    bad.axis_count = 5;
    EXPECT_FALSE(passes(bad));
    bad = frame(1, 1);
    bad.interval_s = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(passes(bad));
    bad = frame(1, 2);
    bad.interval_s = 0;
    EXPECT_FALSE(passes(bad));
    EXPECT_TRUE(passes(frame(1, 3)));
    bad = frame(1, 4);
    bad.sample_time_ns = frame(1, 3).sample_time_ns;
    EXPECT_FALSE(passes(bad));
    bad = frame(1, 5);
    bad.sample_time_ns = std::numeric_limits<std::int64_t>::max();
    EXPECT_FALSE(passes(bad));
    bad = frame(1, 6);
    bad.interval_s = 1e300;
    EXPECT_FALSE(passes(bad));
    bad = frame(1, 7);
    bad.interval_s = std::numeric_limits<double>::denorm_min();
    EXPECT_FALSE(passes(bad));
    EXPECT_TRUE(passes(frame(1, 8)));
    EXPECT_EQ(intake.counters().rejected_frames, 7U);
}

TEST_F(Intake, does_not_take_a_foreign_description_for_its_own)
{
    EXPECT_TRUE(passes(frame(1, 0)));
    auto foreign = ranged(2);
    foreign.axis_count = 6;
    intake.describe(foreign);
    EXPECT_TRUE(passes(frame(1, 1)));
    EXPECT_EQ(intake.description()->epoch, 1U);
}

TEST_F(Intake, says_how_many_frames_were_lost_or_refused_before_one_that_it_lets_through)
{
    ASSERT_TRUE(passes(frame(1, 3)));
    EXPECT_EQ(last.missing_before, 3U) << "the epoch began without us";
    ASSERT_TRUE(passes(frame(1, 4)));
    EXPECT_EQ(last.missing_before, 0U);
    ASSERT_TRUE(passes(frame(1, 7)));
    EXPECT_EQ(last.missing_before, 2U);
    auto bad = frame(1, 8);
    bad.axis_count = 5;
    EXPECT_FALSE(passes(bad));
    ASSERT_TRUE(passes(frame(1, 9)));
    EXPECT_EQ(last.missing_before, 1U);
    EXPECT_EQ(intake.counters().gaps, 2U) << "the refused frame did arrive";

    intake.describe(ranged(2));
    ASSERT_TRUE(passes(frame(2, 5), second_ns));
    EXPECT_EQ(last.missing_before, 5U) << "of the new epoch alone";
}

}  // namespace

}  // namespace quorient::intake
