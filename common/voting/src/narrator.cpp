#include "narrator.hpp"

#include "quorient/messages/words.hpp"

#include <bit>
#include <cinttypes>
#include <cstdarg>
#include <cstdio>

namespace quorient::voting {
namespace {

/// So many changes within the remembered time are a whipsaw, not a reaction.
constexpr unsigned whipsaw_changes = 5;

constexpr double degrees_per_radian = 57.29577951308232;

__attribute__((format(printf, 2, 3))) void write(Name<160>& text, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text.data(), text.size(), format, arguments);
    va_end(arguments);
}

const char* words(LaneExclusion why)
{
    switch (why) {
        case LaneExclusion::silent:
            return "it is silent";
        case LaneExclusion::initialising:
            return "it is initialising";
        case LaneExclusion::disagrees:
            return "it disagrees with the majority";
        case LaneExclusion::uncorroborated:
            return "it isolated axes that no majority of detectors reports";
        case LaneExclusion::outvoted:
            return "it still uses axes that the others have isolated";
        case LaneExclusion::untrusted:
            return "its own detector does not trust it";
        case LaneExclusion::invalid:
            return "it sent something that is not an attitude";
        case LaneExclusion::none:
            break;
    }
    return "";
}

}  // namespace

void Narrator::primary_changed(Identity identity, LaneIndex from, LaneIndex to, const char* reason, double moved_rad,
                               unsigned recent_changes)
{
    const bool whipsaw = recent_changes >= whipsaw_changes;
    VoterEvent& event = add(EventCode::primary_changed, whipsaw ? Severity::warning_high : Severity::warning_low, identity);
    event.lane = lanes_[to].lane;
    write(event.text, "primary lane %.20s -> %.20s: %s; the attitude moved by %.3g deg%s", lanes_[from].name.c_str(),
          lanes_[to].name.c_str(), reason, moved_rad * degrees_per_radian, whipsaw ? "; it changes too often" : "");
}

void Narrator::excluded(Identity identity, LaneIndex lane, LaneExclusion why, AxisMask axes)
{
    const bool passing = why == LaneExclusion::initialising;
    VoterEvent& event = add(EventCode::lane_excluded, passing ? Severity::info : Severity::warning_low, identity);
    event.lane = lanes_[lane].lane;
    event.axes = axes;
    write(event.text, "lane %.20s does not count: %s", lanes_[lane].name.c_str(), words(why));
}

void Narrator::returned(Identity identity, LaneIndex lane, const char* reason)
{
    VoterEvent& event = add(EventCode::lane_returned, Severity::info, identity);
    event.lane = lanes_[lane].lane;
    write(event.text, "lane %.20s counts again: %s", lanes_[lane].name.c_str(), reason);
}

void Narrator::level(Identity identity, VoteLevel before, VoteLevel now, LaneMask standing)
{
    const bool bad = now == VoteLevel::coasting || now == VoteLevel::lost || (now == VoteLevel::single && lanes_.size() > 1);
    const Severity severity = bad ? Severity::warning_high : now == VoteLevel::degraded ? Severity::warning_low : Severity::info;
    const EventCode code = now == VoteLevel::coasting ? EventCode::coasting
                           : now == VoteLevel::lost   ? EventCode::lost
                                                      : EventCode::level_changed;
    VoterEvent& event = add(code, severity, identity);
    write(event.text, "level %s -> %s: %d of %zu lanes stand behind the output", to_string(before).data(), to_string(now).data(),
          std::popcount(standing), lanes_.size());
}

void Narrator::ownership(Identity identity, bool taken_over)
{
    VoterEvent& event = add(EventCode::ownership_taken, taken_over ? Severity::warning_low : Severity::info, identity);
    write(event.text, taken_over ? "this voter took over: the stronger one is silent" : "this voter is the strongest one alive");
}

void Narrator::epoch(Identity identity, std::uint64_t before)
{
    VoterEvent& event = add(EventCode::new_epoch, Severity::info, identity);
    write(event.text, "the lanes are in epoch %" PRIu64 " now (it was %" PRIu64 "), from frame %" PRIu64, identity.epoch, before,
          identity.sequence);
}

void Narrator::away(Identity identity, double delay_s)
{
    VoterEvent& event = add(EventCode::rejected_input, Severity::warning_high, identity);
    write(event.text, "this voter did not run for %.3f s, its lease or nearly so: it listens, then gives out what no other voter has", delay_s);
}

VoterEvent& Narrator::add(EventCode code, Severity severity, Identity identity)
{
    VoterEvent& event = events_.push();
    event = {};
    event.code = code;
    event.severity = severity;
    event.identity = identity;
    return event;
}

}  // namespace quorient::voting
