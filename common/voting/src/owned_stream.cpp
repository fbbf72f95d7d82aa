#include "quorient/voting/owned_stream.hpp"

#include <limits>

namespace quorient::voting {

void OwnedStream::push(const VotedAttitude& output, bool repeated, std::int64_t now_ns)
{
    Waiting& waiting = waiting_.push();
    waiting.output = output;
    waiting.due_ns = now_ns + interval_ns_;
    waiting.repeated = repeated;
}

void OwnedStream::release(VoterRanking& ranking, std::int64_t now_ns)
{
    const VotedAttitude* leader = ranking.leader(now_ns);
    for (const Waiting* first = waiting_.front(); first != nullptr; first = waiting_.front()) {
        if (leader != nullptr && !has_published(*leader, *first) && now_ns < first->due_ns) return;
        if (ranking.may_write({identity_of(first->output), first->output.output_sequence}, first->repeated)) ready_.push() = first->output;
        waiting_.drop_front();
    }
}

std::int64_t OwnedStream::deadline_ns() const
{
    const Waiting* first = waiting_.front();
    return first == nullptr ? std::numeric_limits<std::int64_t>::max() : first->due_ns;
}

bool OwnedStream::has_published(const VotedAttitude& leader, const Waiting& waiting)
{
    return identity_of(leader) >= identity_of(waiting.output);
}

}  // namespace quorient::voting
