#include "report/run_picture.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <regex>

namespace quorient::report {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double interval_s = 0.005;

/// One lane over four gyros at 200 Hz.
class RunPicture : public testing::Test {
protected:
    RunPicture()
    {
        system_.name = "four <gyros>";
        system_.unit = 1;
        system_.interval_s = interval_s;
        auto& lane = system_.lanes.emplace_back();
        lane.name = "a";
        lane.detector.detector = 1;
        ClusterDescription description;
        description.unit = 1;
        description.axis_count = description.instrument_count = 4;
        description.interval_s = interval_s;
        for (std::uint8_t axis = 0; axis < 4; ++axis) {
            description.instrument[axis] = axis;
            copy_text("G" + std::to_string(axis + 1), description.instrument_name[axis]);
        }
        run_.emplace(system_, evaluation::Shadow::off);
        run_->on_description(description);
        timeline_.emplace(system_, *run_);
    }

    static std::int64_t time_ns(std::uint64_t sequence) { return static_cast<std::int64_t>(static_cast<double>(sequence + 1) * interval_s * 1e9); }

    FaultVerdict verdict(std::uint64_t sequence, double statistic) const
    {
        FaultVerdict made;
        made.epoch = epoch_;
        made.unit = made.detector = 1;
        made.sequence = sequence;
        made.sample_time_ns = time_ns(sequence);
        made.statistic = statistic;
        made.threshold = 2;
        return made;
    }

    VotedAttitude voted(std::uint64_t sequence, VoteLevel level) const
    {
        VotedAttitude made;
        made.epoch = epoch_;
        made.unit = 1;
        made.sequence = sequence;
        made.sample_time_ns = time_ns(sequence);
        made.level = octet(level);
        return made;
    }

    std::string picture() const { return run_picture(system_, *run_, *timeline_); }

    system::System system_;
    std::optional<evaluation::RunObserver> run_;
    std::optional<RunTimeline> timeline_;
    std::uint64_t epoch_ = 1;
};

TEST_F(RunPicture, keeps_a_spike_of_one_frame_and_its_memory_however_long_the_run)
{
    for (std::uint64_t sequence = 0; sequence < 100'000; ++sequence) timeline_->on_verdict(verdict(sequence, sequence == 54'321 ? 50 : 1));

    EXPECT_LE(timeline_->moments().size(), RunTimeline::most_moments);
    const auto place = static_cast<std::size_t>((54'322 * interval_s - timeline_->begin_s()) / timeline_->moment_s());
    for (std::size_t i = 0; i < timeline_->moments().size(); ++i)
        EXPECT_EQ(timeline_->moments()[i].lane[0].statistic.largest, i == place ? 25 : 0.5) << i;
    EXPECT_GE(timeline_->moment_s() * static_cast<double>(timeline_->moments().size()), 99'999 * interval_s);
}

TEST_F(RunPicture, goes_on_behind_an_epoch_whose_times_begin_again)
{
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) timeline_->on_verdict(verdict(sequence, 1));
    epoch_ = 2;
    for (std::uint64_t sequence = 0; sequence < 50; ++sequence) timeline_->on_verdict(verdict(sequence, 4));
    epoch_ = 1;
    timeline_->on_verdict(verdict(99, 1000));

    ASSERT_NEAR(static_cast<double>(timeline_->moments().size()), 149, 1);
    EXPECT_EQ(timeline_->moments().front().lane[0].statistic.largest, 0.5);
    EXPECT_EQ(timeline_->moments().back().lane[0].statistic.least, 2) << "a late sample of an epoch that has ended";
}

TEST_F(RunPicture, shows_the_gravest_level_of_a_time_by_the_first_sample_of_each_frame)
{
    for (std::uint64_t sequence = 0; sequence < 2000; ++sequence) {
        timeline_->on_voted(voted(sequence, sequence == 1000 ? VoteLevel::single : VoteLevel::full));
        timeline_->on_voted(voted(sequence, VoteLevel::lost));  // from a voter that is starting
    }
    int single = 0;
    for (const auto& moment : timeline_->moments()) {
        single += moment.level == VoteLevel::single ? 1 : 0;
        EXPECT_NE(moment.level, VoteLevel::lost);
    }
    EXPECT_EQ(single, 1);
    EXPECT_THAT(picture(), HasSubstr("FULL"));
}

TEST_F(RunPicture, names_what_was_left_out_by_the_users_names)
{
    for (std::uint64_t sequence = 0; sequence < 400; ++sequence) {
        auto made = verdict(sequence, sequence < 200 ? 1 : 100);
        if (sequence >= 200) made.isolated_mask = 0b10;
        made.residual[1] = sequence < 200 ? 1e-6 : -1e-4;
        made.bound[1] = 1e-5;
        timeline_->on_verdict(made);
    }
    EXPECT_THAT(picture(), HasSubstr("G2, lane a"));
    EXPECT_THAT(picture(), HasSubstr(">isolated</text>"));
    EXPECT_THAT(picture(), HasSubstr("residual of G2"));
    EXPECT_THAT(picture(), Not(HasSubstr("G1")));
    EXPECT_THAT(picture(), HasSubstr("four &lt;gyros&gt;"));
    EXPECT_EQ(timeline_->moments().back().lane[0].residual[1].largest, 10);
}

TEST_F(RunPicture, has_as_many_rows_of_a_legend_as_its_names_need)
{
    const auto place = [this](const std::string& name) {
        std::smatch found;
        const std::string text = picture();
        EXPECT_TRUE(std::regex_search(text, found, std::regex("<text x='([0-9.]+)' y='([0-9.]+)'>" + name)));
        return std::pair{std::stod(found[1]), std::stod(found[2])};
    };
    auto made = verdict(0, 100);
    made.isolated_mask = 0b1111;
    timeline_->on_verdict(made);
    timeline_->on_verdict(verdict(1, 1));

    const auto first = place("threshold");
    EXPECT_EQ(place("residual of G2").second, first.second);
    EXPECT_EQ(place("residual of G3"), (std::pair{first.first, first.second + 13}));
}

TEST_F(RunPicture, of_a_quiet_run_says_that_nothing_was_left_out)
{
    for (std::uint64_t sequence = 0; sequence < 400; ++sequence) timeline_->on_verdict(verdict(sequence, 1));
    EXPECT_THAT(picture(), HasSubstr("Axes left out: none"));
    EXPECT_THAT(picture(), Not(HasSubstr("isolated")));
    EXPECT_THAT(picture(), Not(HasSubstr("nan")));
}

TEST_F(RunPicture, draws_the_error_where_there_is_a_truth_and_the_attitude_where_there_is_none)
{
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        auto sample = voted(sequence, VoteLevel::full);
        const double half_rad = static_cast<double>(sequence) * 0.05;  // beyond 180 degrees of yaw
        sample.attitude = {std::cos(half_rad), 0, 0, std::sin(half_rad)};
        run_->on_voted(sample);
        timeline_->on_voted(sample);
    }
    EXPECT_THAT(picture(), HasSubstr("Voted attitude"));
    EXPECT_THAT(picture(), Not(HasSubstr("error")));
    EXPECT_NEAR(timeline_->moments().back().roll_pitch_yaw_deg[2].largest, 99 * 0.1 * 180 / std::numbers::pi, 1e-9) << "runs on";

    for (std::uint64_t sequence = 100; sequence < 200; ++sequence) {
        TruthState truth;
        truth.epoch = truth.unit = 1;
        truth.sequence = sequence;
        truth.sample_time_ns = time_ns(sequence);
        truth.attitude_known = 1;
        run_->on_truth(truth);
        timeline_->on_truth(truth);
        auto sample = voted(sequence, VoteLevel::full);
        sample.attitude = {std::cos(0.5e-3), std::sin(0.5e-3), 0, 0};
        run_->on_voted(sample);
        timeline_->on_voted(sample);
    }
    EXPECT_THAT(picture(), HasSubstr("Attitude error against the truth"));
    EXPECT_NEAR(timeline_->moments().back().error_rad.largest, 1e-3, 1e-12);
}

}  // namespace
}  // namespace quorient::report
