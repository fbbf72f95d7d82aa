#include "quorient/evaluation/run_observer.hpp"

#include "quorient/geometry/layouts.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

namespace quorient::evaluation {
namespace {

constexpr std::uint64_t own = 1000, later = 2000;

/// One voter of a unit without lanes; truths and voted attitudes come as the test says.
class RunObserverTest : public testing::Test {
protected:
    RunObserverTest()
    {
        system.unit = 1;
        system.interval_s = 0.005;  // services wait for 100 ms, 20 frames
        observer.emplace(system, Shadow::off);
    }

    void truth(std::uint64_t epoch, std::uint64_t sequence)
    {
        TruthState sample;
        sample.unit = 1;
        sample.epoch = epoch;
        sample.sequence = sequence;
        sample.attitude = {1, 0, 0, 0};
        sample.attitude_known = 1;
        observer->on_truth(sample);
    }

    void voted(std::uint64_t epoch, std::uint64_t sequence, VoteLevel level = VoteLevel::full)
    {
        VotedAttitude sample;
        sample.unit = 1;
        sample.epoch = epoch;
        sample.sequence = sequence;
        sample.output_sequence = ++output;
        sample.attitude = {1, 0, 0, 0};
        sample.level = octet(level);
        observer->on_voted(sample);
    }

    /// Published and voted on.
    void frames(std::uint64_t epoch, std::uint64_t begin, std::uint64_t end)
    {
        for (std::uint64_t sequence = begin; sequence < end; ++sequence) {
            truth(epoch, sequence);
            voted(epoch, sequence);
        }
    }

    system::System system;
    std::optional<RunObserver> observer;
    std::uint64_t output = 0;
};

TEST_F(RunObserverTest, ends_with_the_level_of_the_last_frame_where_the_source_ended_in_order)
{
    frames(own, 0, 100);
    voted(own, 99, VoteLevel::coasting);
    observer->on_source_ended();
    voted(own, 99, VoteLevel::lost);
    EXPECT_EQ(observer->final_level(), VoteLevel::full);
}

TEST_F(RunObserverTest, ends_with_a_lost_level_where_the_source_fell_silent)
{
    frames(own, 0, 100);
    voted(own, 99, VoteLevel::coasting);
    voted(own, 99, VoteLevel::lost);
    EXPECT_EQ(observer->final_level(), VoteLevel::lost);
}

TEST_F(RunObserverTest, counts_no_frame_of_a_second_publisher_that_services_ignore_as_missing)
{
    frames(own, 0, 100);
    for (std::uint64_t sequence = 0; sequence < 300; ++sequence) {
        truth(later, sequence);
        frames(own, 100 + sequence, 101 + sequence);
    }
    EXPECT_EQ(observer->missing_voted(), 0U);
    EXPECT_EQ(observer->truth_frames(), 400U);
    EXPECT_EQ(observer->newest_truth().epoch, own);
}

TEST_F(RunObserverTest, counts_a_missing_frame_of_the_publisher_that_services_follow)
{
    frames(own, 0, 100);
    truth(own, 100);
    frames(own, 101, 200);
    EXPECT_EQ(observer->missing_voted(), 1U);
}

TEST_F(RunObserverTest, counts_a_restarted_publisher_from_its_first_frame)
{
    frames(own, 0, 100);
    truth(later, 0);  // no voted attitude
    frames(later, 1, 100);
    EXPECT_EQ(observer->newest_truth().epoch, later);
    EXPECT_EQ(observer->missing_voted(), 1U);
    EXPECT_EQ(observer->voted().errors.compared, 199U);
}

TEST_F(RunObserverTest, follows_a_second_publisher_once_the_first_one_is_silent_as_services_do)
{
    frames(own, 0, 100);
    truth(later, 0);
    frames(own, 100, 101);
    for (std::uint64_t sequence = 1; sequence < 20; ++sequence) truth(later, sequence);  // services still wait for the first one
    frames(later, 20, 100);
    EXPECT_EQ(observer->newest_truth().epoch, later);
    EXPECT_LE(observer->missing_voted(), 1U);  // the frame at the very end of the silence
}

/// The error at the end without roll-back, of four gyros at rest. Axis 1 is wrong from frame `onset` on, which the verdict on frame
/// `onset` + 1 says; the observer receives it when it has received `frames_before` frames.
double error_without_rollback(std::uint64_t frames_before)
{
    constexpr std::uint64_t onset = 50, end = 100;
    system::System system;
    system.unit = 1;
    system.lanes.emplace_back().detector.detector = 4;
    RunObserver observer(system);

    ClusterDescription description;
    description.unit = 1;
    description.epoch = own;
    description.kind = octet(SensorKind::gyro);
    description.axis_count = 4;
    description.interval_s = 0.005;
    description.initial_attitude = {1, 0, 0, 0};
    description.initial_attitude_known = 1;
    const auto cluster = geometry::layout("cone-4").value();
    for (std::size_t axis = 0; axis < 4; ++axis)
        Eigen::Map<Eigen::Vector3d>(description.axis[axis].data()) = cluster.axes.row(static_cast<Eigen::Index>(axis)).transpose();
    observer.on_description(description);

    FaultVerdict verdict;
    verdict.unit = 1;
    verdict.detector = 4;
    verdict.epoch = own;
    verdict.sequence = onset + 1;
    verdict.kind = octet(SensorKind::gyro);
    verdict.state = octet(VerdictState::isolated);
    verdict.isolated_mask = axis_bit(1);
    verdict.excluded_from[1] = onset;
    double accumulated = 0;
    for (std::uint64_t sequence = 0; sequence < end; ++sequence) {
        if (sequence == frames_before) observer.on_verdict(verdict);
        TruthState truth;
        truth.unit = 1;
        truth.epoch = own;
        truth.sequence = sequence;
        truth.attitude = {1, 0, 0, 0};
        truth.attitude_known = 1;
        truth.faulty_mask = sequence >= onset ? axis_bit(1) : 0;
        observer.on_truth(truth);
        SensorFrame frame;
        frame.unit = 1;
        frame.epoch = own;
        frame.sequence = sequence;
        frame.sample_time_ns = static_cast<std::int64_t>(sequence + 1) * 5'000'000;
        frame.interval_s = 0.005;
        frame.kind = octet(SensorKind::gyro);
        frame.axis_count = 4;
        frame.valid_mask = all_axes(4);
        frame.increment[1] = sequence >= onset ? 1e-4 : 0;
        frame.accumulated[1] = accumulated += frame.increment[1];
        observer.on_frame(frame);
    }
    return observer.without_rollback().final_rad;
}

TEST(WithoutRollback, the_fault_is_in_until_the_frame_of_its_verdict_whichever_arrives_first)
{
    const double in_order = error_without_rollback(52);
    EXPECT_GT(in_order, 1e-4);
    EXPECT_LT(in_order, 3e-4);
    EXPECT_EQ(error_without_rollback(45), in_order);  // as on a machine that lets the observer run late
}

}  // namespace
}  // namespace quorient::evaluation
