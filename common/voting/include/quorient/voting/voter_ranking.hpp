#pragma once

#include "quorient/messages/identity.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/voting/voter_settings.hpp"

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

/// What the other voters of the unit publish, whom this one follows, and what it may write to `voted`.
///
/// A voter follows the strongest fresh voter among those stronger than itself. It writes `voted` only after a number of good frames, and
/// never steps back: when it begins to write, nothing at or below what any voter has published. One that has never heard a stronger one
/// first gives the two time to find each other: a reader that finds both at different moments would be given frames twice.
class VoterRanking {
public:
    explicit VoterRanking(const VoterSettings& settings);

    bool has_others() const { return !others_.empty(); }
    bool has_stronger() const { return !others_.empty() && others_.front().stronger; }

    /// Some other voter has been heard.
    bool has_heard() const;

    /// @returns false for own samples and for voters that are not in the list.
    bool on_output(const VotedAttitude& output, std::int64_t now_ns);

    /// The newest output of the voter that this one follows; null where there is none to follow.
    const VotedAttitude* leader(std::int64_t now_ns) const;

    /// The leader's output of this frame, and the last one before it; null where not known.
    const VotedAttitude* leader_at(Identity identity, std::int64_t now_ns) const;
    const VotedAttitude* leader_before(Identity identity, std::int64_t now_ns) const;

    /// The primary lane's id that the leader named in each of its newest frames; none while it changes.
    std::optional<std::uint32_t> leaders_primary(std::uint64_t frames, std::int64_t now_ns) const;

    /// The farthest output of all fresh voters; null where there is none.
    const VotedAttitude* farthest(std::int64_t now_ns) const;

    /// The number of the next output, of this frame: above all own ones and in step with the others'. Of one who
    /// knows of none: above what they can have had, unless their publisher restarted.
    std::uint64_t next_output_sequence(Identity identity) const;

    /// Told of every own output.
    void published(std::uint64_t output_sequence) { own_sequence_ = output_sequence; }

    /// Whether this output may be written to `voted`. To be asked once for every output, in order.
    bool may_write(Position position, bool repeated);

    /// The voter was away, or has just started.
    void start_over();

    bool established() const;

    /// Another voter is fresh and has come farther than this.
    bool is_behind(Identity identity, std::int64_t now_ns) const;

    /// When the leader ends to be fresh.
    std::int64_t leader_ends_ns(std::int64_t now_ns) const;

private:
    static constexpr std::uint64_t remembered = 16;

    struct Other {
        std::uint32_t voter = 0;
        bool stronger = false;
        bool heard = false;
        std::int64_t heard_ns = 0;
        Position newest;
        std::array<VotedAttitude, remembered> output{};  ///< by sequence
    };

    bool has_heard_stronger() const;
    static std::uint64_t number_beside(const Other& other, Identity identity);
    const Other* leading(std::int64_t now_ns) const;
    bool must_hold_back(Position position) const;
    std::int64_t fresh_until_ns(const Other& other) const;
    static const VotedAttitude& newest(const Other& other) { return other.output[other.newest.identity.sequence % remembered]; }

    std::uint32_t unit_;
    std::vector<Other> others_;  ///< strongest first
    std::int64_t lease_ns_;
    std::int64_t coasting_interval_ns_;
    unsigned good_frames_required_;
    unsigned good_frames_ = 0;
    unsigned listen_frames_;
    unsigned listened_ = 0;   ///< good frames since the process began
    unsigned held_back_ = 0;  ///< frames since it was established that it left to a weaker voter
    bool writing_ = false;
    std::uint64_t own_sequence_ = 0;
    Position written_;
    Position highest_seen_;
};

}  // namespace quorient::voting
