#pragma once

#include "ballot.hpp"
#include "corroboration.hpp"
#include "durations.hpp"
#include "lane_board.hpp"
#include "narrator.hpp"
#include "newcomers.hpp"
#include "timeline.hpp"

#include <cstdint>
#include <optional>

namespace quorient::voting {

/// The frames as the lanes deliver them: which are received, what the lanes say of each, and which is ready to be published.
class Frames {
public:
    Frames(const VoterSettings& settings, const Durations& durations, Narrator& narrator, VoterCounters& counters);

    void on_attitude(const AttitudeState& attitude, std::int64_t now_ns);
    void on_verdict(const FaultVerdict& verdict, std::int64_t now_ns);

    /// The first frame of a new epoch, or of a jump in the sequences, once the lanes are believed.
    std::optional<Identity> new_timeline(std::int64_t now_ns) const { return newcomers_.accepted(now_ns); }

    /// Patience and silence are these from now on.
    void keep_pace(const Durations& durations)
    {
        durations_ = durations;
        corroboration_.keep_pace(durations.silence_ns);
    }

    /// Goes over to the new timeline. @param published  nothing up to this one may be published.
    void start(Identity first, std::optional<Identity> published, std::int64_t now_ns);

    /// Frames up to this one will not be published.
    void pass(Identity identity) { timeline_.pass(identity); }

    /// Excludes lanes that are silent; where no other lane is left, those that deliver again count at once.
    void judge_silence(std::int64_t now_ns);

    /// The first frame that may be published, and the one after `sequence`.
    std::optional<std::uint64_t> first() const { return timeline_.next_open(timeline_.next()); }

    /// When the first frame that is not published yet was received.
    std::optional<std::int64_t> waiting_since_ns() const
    {
        const auto waiting = first();
        return waiting ? std::optional(timeline_.due_ns(*waiting)) : std::nullopt;
    }
    std::optional<std::uint64_t> after(std::uint64_t sequence) const { return timeline_.next_open(sequence + 1); }

    Ballot ballot(std::uint64_t sequence, LaneIndex wanted, LaneIndex current, std::int64_t now_ns) const;

    /// Nothing that could change the outcome is worth waiting for. @param not_before_ns  patience lasts until then at least.
    bool is_ready(std::uint64_t sequence, const Ballot& ballot, LaneIndex wanted, std::int64_t not_before_ns, std::int64_t now_ns) const;

    /// The frame is published with this outcome.
    void publish(std::uint64_t sequence, const Ballot& ballot, std::int64_t now_ns);

    /// Draws the conclusions about the lanes, after the output is out, so that it never names an excluded primary.
    void conclude(Identity published, std::int64_t now_ns);

    /// The votes no longer say how many lanes stand behind the output.
    void forget_levels() { board_.start_levels_over(); }

    VoteLevel level(LaneIndex primary) const;
    LaneMask standing() const { return board_.levels().standing(); }
    LaneMask excluded() const { return board_.excluded(); }
    const LaneTracker& lane(LaneIndex index) const { return board_.lane(index); }
    std::size_t lanes() const { return board_.size(); }
    std::optional<LaneIndex> lane_of(std::uint32_t lane_id) const;
    Identity identity(std::uint64_t sequence) const { return timeline_.identity(sequence); }
    std::optional<Identity> newest() const;

    /// The first frame of the present timeline that any lane delivered, even where it came later than others, yet within their window.
    std::optional<Identity> first_received() const { return first_received_; }
    std::uint64_t epoch() const { return timeline_.epoch(); }

    /// Calls `consider` with the times at which something changes here by itself.
    template <class Consider>
    void consider_deadlines(Consider consider) const
    {
        consider(newcomers_.deadline_ns());
        consider(board_.silence_deadline_ns(timeline_, durations_.silence_ns));
        for (auto waiting = first(); waiting; waiting = after(*waiting)) consider(timeline_.due_ns(*waiting) + durations_.patience_ns);
    }

    /// @returns nullptr while this agrees with itself, otherwise what is wrong. For tests.
    const char* broken_invariant() const { return board_.broken_invariant(); }

private:
    void receive(LaneIndex lane, const AttitudeState& attitude, std::int64_t now_ns);
    LaneMask using_condemned_axes(const BallotPaper& paper) const;
    bool is_better_to_come(Identity identity, AxisMask left_out, std::int64_t now_ns) const;
    bool is_complete(Identity identity, bool several_groups, std::int64_t now_ns) const;

    const VoterSettings& settings_;  ///< Ids of the unit, its lanes and detectors.
    Durations durations_;            ///< Patience and silence are used.
    std::size_t majority_;           ///< So many of the configured lanes are a majority.
    std::optional<Identity> first_received_;  ///< The first frame of the timeline; frames may have come before it was believed.
    Timeline timeline_;              ///< Which frames exist, which are passed, and when each is due.
    Newcomers newcomers_;            ///< Samples that the timeline did not expect.
    Corroboration corroboration_;    ///< What the detectors report.
    LaneBoard board_;                ///< The lanes' samples, and how each lane stands. Refers to corroboration_ and the narrator.
    Narrator& narrator_;             ///< Reports a new epoch.
    VoterCounters& counters_;        ///< Counts what is received and refused, and published.
};

}  // namespace quorient::voting
