#pragma once

#include "joining.hpp"
#include "lane_board.hpp"
#include "narrator.hpp"
#include "quorient/voting/bounded_queue.hpp"
#include "quorient/voting/continuity.hpp"
#include "quorient/voting/corroboration.hpp"
#include "quorient/voting/newcomers.hpp"
#include "quorient/voting/owned_stream.hpp"
#include "quorient/voting/timeline.hpp"
#include "quorient/voting/voter.hpp"
#include "quorient/voting/voter_ranking.hpp"

#include <array>
#include <optional>

namespace quorient::voting {

/// Frame by frame: who is heard, what is decided, what goes out. The parts it plays on each know one thing.
class Voter::Brain {
public:
    explicit Brain(const VoterSettings& settings);

    void on_attitude(const AttitudeState& attitude, std::int64_t now_ns);
    void on_verdict(const FaultVerdict& verdict, std::int64_t now_ns);
    void on_other_voter(const VotedAttitude& output, std::int64_t now_ns);
    void poll(std::int64_t now_ns);

    std::int64_t next_deadline_ns() const { return promised_ns_; }
    bool next_output(Output& output) { return outputs_.pop(output); }
    bool next_owned(VotedAttitude& output) { return owned_.next(output); }
    bool next_event(VoterEvent& event) { return narrator_.next(event); }
    const VoterCounters& counters() const { return counters_; }
    VoteLevel level() const { return level_; }
    std::uint32_t primary_lane() const { return continuity_.started() ? settings_.lanes[primary_].lane : 0; }
    bool owns() const { return owns_; }
    bool may_own() const;

private:
    void notice(std::int64_t now_ns);
    void start_over(std::int64_t away_ns);
    void finish_joining();
    void adopt(const VotedAttitude& output);

    std::optional<LaneIndex> lane_of(std::uint32_t unit, std::uint32_t id, std::uint32_t LaneSettings::*member) const;
    void receive(LaneIndex lane, const AttitudeState& attitude);
    void consider_newcomers();

    void go_on();
    void publish_what_is_ready(bool at_once);
    BallotPaper paper_of(std::uint64_t sequence) const;
    LaneMask using_condemned_axes(const BallotPaper& paper) const;
    bool is_ready(std::uint64_t sequence, const Ballot& ballot) const;
    bool is_better_to_come(Identity identity, AxisMask isolated) const;
    bool is_complete(Identity identity, bool several_groups) const;
    LaneIndex wanted_primary() const;
    bool is_stand_in(Identity identity, LaneIndex lane) const;

    void publish(std::uint64_t sequence, const Ballot& ballot);
    Continuity::Reset continue_stream(Identity identity, const AttitudeState& sample);
    void change_primary(Identity identity, LaneIndex to, double moved_rad);
    const char* reason_to_leave(Identity identity, LaneIndex to) const;
    void fill(VotedAttitude& output, const AttitudeState& sample, const Ballot& ballot, const Continuity::Reset& reset) const;
    void coast_if_due();
    void emit(const VotedAttitude& output, bool repeated);
    void set_level(Identity identity, VoteLevel level);
    void plan();

    VoterSettings settings_;
    std::int64_t interval_ns_;
    std::int64_t patience_ns_;
    std::int64_t silence_ns_;
    std::int64_t lease_ns_;
    std::int64_t coasting_interval_ns_;
    std::int64_t coasting_to_lost_ns_;
    std::size_t majority_;

    Narrator narrator_;
    Timeline timeline_;
    Newcomers newcomers_;
    Corroboration corroboration_;
    LaneBoard board_;
    Continuity continuity_;
    VoterRanking ranking_;
    OwnedStream owned_;
    Joining joining_;
    BoundedQueue<Output, 128> outputs_;
    VoterCounters counters_;

    std::optional<std::int64_t> now_;
    std::int64_t promised_ns_ = 0;          ///< when poll was asked for
    std::optional<std::int64_t> spoke_ns_;  ///< the last output, where that was a frame's

    LaneIndex primary_ = 0;
    std::array<std::uint64_t, 8> change_{};  ///< outputs at which the primary changed
    VotedAttitude last_;                     ///< output
    std::int64_t last_frame_ns_ = 0;
    std::int64_t coasted_ns_ = 0;
    VoteLevel level_ = VoteLevel::unknown;
    bool owns_ = false;
};

}  // namespace quorient::voting
