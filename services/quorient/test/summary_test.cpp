#include "report/summary.hpp"

#include "quorient/messages/meaning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <optional>

namespace quorient::report {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The demo's system: 100 frames, each published and voted on. Then the voters report for a while that no frame comes.
class Summary : public testing::Test {
protected:
    Summary()
    {
        auto loaded = system::load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml");
        EXPECT_TRUE(loaded);
        system_.emplace(std::move(*loaded));
        run_.emplace(*system_, evaluation::Shadow::off);
        for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
            TruthState truth;
            truth.unit = system_->unit;
            truth.epoch = 1;
            truth.sequence = sequence;
            run_->on_truth(truth);
            vote(sequence, VoteLevel::full);
        }
    }

    void vote(std::uint64_t sequence, VoteLevel level)
    {
        VotedAttitude voted;
        voted.unit = system_->unit;
        voted.epoch = 1;
        voted.sequence = sequence;
        voted.output_sequence = ++output_;
        voted.level = octet(level);
        run_->on_voted(voted);
    }

    void no_more_frames()
    {
        vote(99, VoteLevel::coasting);
        vote(99, VoteLevel::lost);
    }

    std::optional<system::System> system_;
    std::optional<evaluation::RunObserver> run_;
    std::uint64_t output_ = 0;
};

TEST_F(Summary, of_a_run_that_ended_in_order_states_the_level_at_its_last_frame)
{
    run_->on_source_ended();
    no_more_frames();
    EXPECT_THAT(summary_text(*system_, *run_), AllOf(HasSubstr("100 frames, 0 missing, level FULL"), Not(HasSubstr("LOST"))));
    EXPECT_EQ(summary_json(*system_, *run_)["voted"]["level"], "FULL");
}

TEST_F(Summary, of_a_run_whose_source_fell_silent_says_that_the_level_is_lost)
{
    no_more_frames();
    EXPECT_THAT(summary_text(*system_, *run_), HasSubstr("100 frames, 0 missing, level LOST"));
    EXPECT_EQ(summary_json(*system_, *run_)["voted"]["level"], "LOST");
}

}  // namespace
}  // namespace quorient::report
