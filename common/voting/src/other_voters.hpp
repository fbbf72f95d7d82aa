#pragma once

#include "durations.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "timeline.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

namespace quorient::voting {

/// Where a stream of outputs has come to.
struct Position {
    Identity identity;
    std::uint64_t output_sequence = 0;

    auto operator<=>(const Position&) const = default;
};

Position position_of(const VotedAttitude& output);

/// What another voter has published on `voter_output`.
class OtherVoter {
public:
    OtherVoter(std::uint32_t id, bool stronger) : id_(id), stronger_(stronger) {}

    void store(const VotedAttitude& output, std::int64_t now_ns);

    std::uint32_t id() const { return id_; }
    bool stronger() const { return stronger_; }
    bool seen() const { return seen_; }
    const Position& position() const { return newest_; }
    const VotedAttitude& newest() const { return output_[newest_.identity.sequence % frame_window]; }

    /// Its output of this frame, and its last one before this frame; null where none is remembered.
    const VotedAttitude* at(Identity identity) const;
    const VotedAttitude* before(Identity identity) const;

    /// The primary lane's id that it named in each of its newest frames; none while that changes.
    std::optional<std::uint32_t> steady_primary(std::uint64_t frames) const;

    /// The number that keeps in step with it: its own number of this frame, or what that will be when it has published all frames up to it.
    std::uint64_t number_beside(Identity identity) const;

    /// It counts as alive until then. One that repeats its last attitude publishes less often.
    std::int64_t fresh_until_ns(const Durations& durations) const;

    /// @returns nullptr while this agrees with itself, otherwise what is wrong. For tests.
    const char* broken_invariant() const;

private:
    std::uint32_t id_;                                  ///< Its id in the list of voters.
    bool stronger_;                                     ///< It stands before this voter in the list of voters.
    bool seen_ = false;                                 ///< At least one output has arrived; the members below mean nothing before.
    std::int64_t received_ns_ = 0;                      ///< When its last output arrived, old or new.
    Position newest_;                                   ///< The farthest of its outputs; output_ holds that one.
    std::array<VotedAttitude, frame_window> output_{};  ///< Its outputs by sequence; output_sequence 0 marks an empty place.
};

/// What is known of the unit's other voters. A voter follows the strongest fresh one among those that are stronger than itself.
class OtherVoters {
public:
    OtherVoters(const VoterSettings& settings, const Durations& durations);

    bool exist() const { return !others_.empty(); }
    bool seen() const;
    bool stronger_exist() const { return !others_.empty() && others_.front().stronger(); }
    bool stronger_seen() const;

    /// @returns false for a voter that is not in the list, and for what is no attitude.
    bool on_output(const VotedAttitude& output, std::int64_t now_ns);

    /// The voter that this one follows; null where there is none.
    const OtherVoter* leader(std::int64_t now_ns) const;

    /// When the leader ceases to be fresh.
    std::int64_t leader_ends_ns(std::int64_t now_ns) const;

    /// The fresh voter that has come farthest; null where there is none.
    const OtherVoter* farthest(std::int64_t now_ns) const;

    /// Any voter's output of this frame, and the last one before it; null where none is remembered.
    const VotedAttitude* at(Identity identity) const;
    const VotedAttitude* before(Identity identity) const;

    /// A fresh voter has come farther than this.
    bool are_ahead_of(Identity identity, std::int64_t now_ns) const;

    /// The farthest frame of all weaker voters, fresh or not.
    Identity weaker_reached() const;

    /// The same of all stronger voters.
    Identity stronger_reached() const;

    /// A weaker voter is fresh.
    bool weaker_fresh(std::int64_t now_ns) const;

    /// The farthest output of all.
    const Position& reached() const { return reached_; }

    /// The number of this voter's next output: above its own last one and in step with the others'. A voter that knows of no other numbers
    /// by sequence: above what the others can have had, unless the publisher restarted.
    std::uint64_t next_output_sequence(Identity identity, std::uint64_t own_last) const;

    /// @returns nullptr while this agrees with itself, otherwise what is wrong. For tests.
    const char* broken_invariant() const;

private:
    Identity reached_by(bool stronger) const;

    std::uint32_t unit_;              ///< The unit whose outputs are accepted.
    Durations durations_;             ///< They say for how long a voter is fresh.
    std::vector<OtherVoter> others_;  ///< All other voters, strongest first.
    Position reached_;                ///< The maximum over every output received; it never goes back.
};

}  // namespace quorient::voting
