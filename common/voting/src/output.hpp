#pragma once

#include "bounded_queue.hpp"
#include "continuity.hpp"
#include "durations.hpp"
#include "frames.hpp"
#include "other_voters.hpp"
#include "owned_stream.hpp"

#include <array>
#include <cstdint>

namespace quorient::voting {

/// The stream that this voter publishes: whose attitude it is, how it follows on the one before, at which level, and what is repeated while
/// no frames come.
class Output {
public:
    Output(const VoterSettings& settings, const Durations& durations, const OtherVoters& others, Frames& frames, OwnedStream& owned,
           Narrator& narrator, VoterCounters& counters);

    /// Silence lasts so long from now on.
    void keep_pace(const Durations& durations) { durations_ = durations; }

    /// The stream goes on from another voter's output, unless it is farther already.
    void adopt(const VotedAttitude& output, std::int64_t now_ns);

    /// The lane that should be the primary: the stronger voter's choice if that one has kept it for some frames, otherwise the one that is.
    LaneIndex wanted_primary(std::int64_t now_ns) const;

    /// Moves the stream to this lane's sample. @returns how consumers learn that the attitude moved.
    Continuity::Reset move_to(LaneIndex lane, Identity identity, std::int64_t now_ns);

    /// Publishes the primary's sample of this frame. The frames know the outcome already.
    void publish(Identity identity, const Ballot& ballot, const Continuity::Reset& reset, std::int64_t now_ns);

    /// Repeats the last attitude, with a growing standard deviation, when no frames come. @returns whether it did.
    bool coast_if_due(std::int64_t now_ns);

    bool next(VotedAttitude& output) { return outputs_.pop(output); }

    bool started() const { return continuity_.started(); }
    Identity identity() const { return continuity_.identity(); }
    LaneIndex primary() const { return primary_; }
    VoteLevel level() const { return level_; }

    /// The newest output repeats a frame that was published before.
    bool repeats() const { return repeated_ns_ > frame_ns_; }

    /// Calls `consider` with the times at which something changes here by itself.
    template <class Consider>
    void consider_deadlines(Consider consider) const
    {
        if (!started()) return;
        consider(frame_ns_ + durations_.silence_ns);
        if (repeats()) consider(repeated_ns_ + durations_.coasting_interval_ns);
    }

    /// @returns nullptr while this agrees with itself, otherwise what is wrong. For tests.
    const char* broken_invariant() const;

private:
    bool stands_in(LaneIndex lane, Identity identity, std::int64_t now_ns) const;
    const char* reason_to_leave(Identity identity, LaneIndex to, std::int64_t now_ns) const;
    VotedAttitude filled(const AttitudeState& sample, const Ballot& ballot, const Continuity::Reset& reset) const;
    void set_level(VoteLevel level, Identity identity);
    void emit(const VotedAttitude& output, bool repeated, std::int64_t now_ns);

    const VoterSettings& settings_;             ///< Ids and names are used.
    Durations durations_;                       ///< Silence and coasting are used.
    const OtherVoters& others_;                 ///< Their choice of primary, resets and numbers are followed.
    Frames& frames_;                            ///< The lanes' samples and how the lanes stand; coasting makes them forget the level.
    OwnedStream& owned_;                        ///< Every output is passed on to it.
    Narrator& narrator_;                        ///< Reports changes of primary and level.
    VoterCounters& counters_;                   ///< Counts what is published, gaps and changes of primary.
    Continuity continuity_;                     ///< The newest frame of the stream, own or adopted; last_ is the same frame.
    BoundedQueue<VotedAttitude, longest_burst> outputs_;  ///< Outputs in order that next() hands out.
    LaneIndex primary_ = 0;                     ///< Whose attitude is the output. Means nothing before the first output.
    std::array<std::uint64_t, 8> changes_{};    ///< Values of counters_.published at the latest changes of primary.
    VotedAttitude last_;                        ///< The newest frame's output, own or adopted; what coasting repeats.
    std::uint64_t own_sequence_ = 0;            ///< output_sequence of the last own output; 0 before the first one.
    std::int64_t frame_ns_ = 0;                 ///< When the stream last went on by a frame, own or adopted.
    std::int64_t repeated_ns_ = 0;              ///< When an output was last repeated.
    VoteLevel level_ = VoteLevel::unknown;      ///< Level of the newest own output.
};

}  // namespace quorient::voting
