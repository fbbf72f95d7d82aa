#pragma once

#include "quorient/voting/bounded_queue.hpp"
#include "quorient/voting/voter_ranking.hpp"

#include <cstdint>

namespace quorient::voting {

/// What a voter writes to `voted`, where a plain reader listens to the strongest writer that lives.
///
/// A reader that has just found the stronger writer, or lost it, changes over in the middle of both streams. So that this never shows it
/// a frame twice, a voter that follows another writes a frame only after that one has published it, or an interval later than its own
/// turn where that one does not.
class OwnedStream {
public:
    explicit OwnedStream(std::int64_t interval_ns) : interval_ns_(interval_ns) {}

    /// Every output, in order. @param repeated  it stands for no frame of its own
    void push(const VotedAttitude& output, bool repeated, std::int64_t now_ns);

    /// Lets out what the ranking allows by now; to be asked whenever time passes or another voter was heard.
    void release(VoterRanking& ranking, std::int64_t now_ns);

    bool next(VotedAttitude& output) { return ready_.pop(output); }

    /// When something is let out at the latest.
    std::int64_t deadline_ns() const;

private:
    struct Waiting {
        VotedAttitude output;
        std::int64_t due_ns = 0;
        bool repeated = false;
    };

    static bool has_published(const VotedAttitude& leader, const Waiting& waiting);

    std::int64_t interval_ns_;
    BoundedQueue<Waiting, 32> waiting_;
    BoundedQueue<VotedAttitude, 64> ready_;
};

}  // namespace quorient::voting
