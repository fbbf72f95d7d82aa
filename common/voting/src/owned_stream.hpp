#pragma once

#include "bounded_queue.hpp"
#include "other_voters.hpp"
#include "punctuality.hpp"

#include <cstdint>

namespace quorient::voting {

/// What this voter writes to `voted`, and when. A plain reader receives the strongest writer that lives; when it changes from one writer to
/// another it must see no frame twice and none that is older. Hence three rules:
///
/// 1. A voter has the right to write only after a number of good frames. One that has never received a stronger voter first gives both
///    `listen_s` to discover each other. An absence ends the right, and it returns after one lease and so many intervals at the earliest;
///    at once where nobody has taken over.
/// 2. It begins with a frame that no voter has published yet, and early enough that no weaker one can have ceased to wait for it.
/// 3. A frame is written in the order of strength: after the leader has published it, or an interval late where the leader does not.
///    One that falls behind the leader by half a lease passes frames over until it has caught up.
class OwnedStream {
public:
    OwnedStream(const VoterSettings& settings, const Durations& durations);

    /// Every output is pushed, in order. @param repeated  it stands for no frame of its own.
    void push(const VotedAttitude& output, bool repeated, std::int64_t now_ns);

    /// Writes what is due by now. To be called whenever time passes or another voter's output arrives.
    void release(const OtherVoters& others, std::int64_t now_ns);

    bool next(VotedAttitude& output) { return may_write() && ready_.pop(output); }

    /// This voter was away: another one may own `voted` now, and have written what next() has not handed out yet.
    void start_over(std::int64_t now_ns);

    /// This voter wrote `voted` before it was away, and no other voter has written it since.
    void resume(const OtherVoters& others);

    /// The right to write is there, although the first frame to be written may still be to come.
    bool may_write() const { return right_ != Right::proving; }

    /// When something is written at the latest.
    std::int64_t deadline_ns() const;

    /// @returns nullptr while this agrees with itself, otherwise what is wrong. For tests.
    const char* broken_invariant() const;

private:
    enum class Right {
        proving,  ///< Too few good frames so far, or a stronger voter may be undiscovered. Ends when both are settled.
        holding,  ///< A weaker voter has published these frames already, or may have; ends with the first frame that it cannot have.
        writing,  ///< Every later frame is written. Ends when this voter was away.
    };

    struct Waiting {
        VotedAttitude output;
        std::int64_t due_ns = 0;
        bool repeated = false;
    };

    void consider_right(const OtherVoters& others, std::int64_t now_ns);
    bool passes_over(Identity identity, const OtherVoters& others);
    bool must_hold(Identity identity, const OtherVoters& others, std::int64_t now_ns) const;
    bool may_write(const Waiting& waiting, const OtherVoters& others, std::int64_t now_ns);

    std::int64_t interval_ns_;                ///< A follower waits so long for the leader's output of a frame.
    std::int64_t lease_ns_;                   ///< The right returns so long after an absence at the earliest.
    unsigned good_frames_required_;           ///< Good frames until the right to write.
    std::uint64_t lag_frames_;                ///< One that is farther behind a stronger voter passes frames over.
    unsigned listen_frames_;                  ///< Good frames after which an unseen stronger voter is taken to be absent.
    BoundedQueue<Waiting, longest_burst> waiting_;      ///< Outputs in order that are neither written nor passed over yet.
    BoundedQueue<VotedAttitude, longest_burst> ready_;  ///< Outputs in order that next() hands out.
    Right right_ = Right::proving;            ///< Changed by consider_right(), must_hold(), start_over() and resume() alone.
    unsigned good_frames_ = 0;                ///< Own frames since the start or the last absence.
    unsigned listened_ = 0;                   ///< Own frames since the start.
    unsigned held_ = 0;                       ///< Frames passed over while holding.
    bool behind_ = false;                     ///< Frames are passed over until a stronger voter is reached.
    std::int64_t not_before_ns_;              ///< The right does not return before.
    Punctuality punctuality_;                 ///< How late a frame is here.
    Position written_;                        ///< Nothing at or before this is written any more.
};

}  // namespace quorient::voting
