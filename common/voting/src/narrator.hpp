#pragma once

#include "ballot.hpp"
#include "bounded_queue.hpp"
#include "quorient/voting/voter.hpp"

namespace quorient::voting {

/// Reports to an operator in plain words what the voter did.
class Narrator {
public:
    explicit Narrator(const VoterSettings& settings) : lanes_(settings.lanes) {}

    void primary_changed(Identity identity, LaneIndex from, LaneIndex to, const char* reason, double moved_rad, unsigned recent_changes);
    void excluded(Identity identity, LaneIndex lane, LaneExclusion why, AxisMask axes);
    void returned(Identity identity, LaneIndex lane, const char* reason);
    void level(Identity identity, VoteLevel before, VoteLevel now, LaneMask standing);
    void ownership(Identity identity, bool taken_over);
    void epoch(Identity identity, std::uint64_t before);
    void away(Identity identity, double delay_s);

    bool next(VoterEvent& event) { return events_.pop(event); }

private:
    VoterEvent& add(EventCode code, Severity severity, Identity identity);

    std::vector<LaneSettings> lanes_;
    BoundedQueue<VoterEvent, 64> events_;
};

}  // namespace quorient::voting
