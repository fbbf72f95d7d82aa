#include "quorient/voting/voter.hpp"

#include "frames.hpp"
#include "listening.hpp"
#include "narrator.hpp"
#include "other_voters.hpp"
#include "output.hpp"
#include "owned_stream.hpp"
#include "quorient/messages/time.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace quorient::voting {

std::string_view to_string(VoterState state)
{
    constexpr std::array<std::string_view, voter_states.size()> names{"listening", "waiting", "following", "owning", "cut_off"};
    return names[static_cast<std::size_t>(state)];
}

Voter::Voter(const VoterSettings& settings)
    : settings_(std::make_unique<const VoterSettings>(settings)),
      counters_(std::make_unique<VoterCounters>()),
      promised_ns_(std::numeric_limits<std::int64_t>::min())
{
    assert(check(settings) && "settings are to be checked first");
    const Durations durations(settings);
    narrator_ = std::make_unique<Narrator>(*settings_);
    others_ = std::make_unique<OtherVoters>(*settings_, durations);
    frames_ = std::make_unique<Frames>(*settings_, durations, *narrator_, *counters_);
    owned_ = std::make_unique<OwnedStream>(*settings_, durations);
    output_ = std::make_unique<Output>(*settings_, durations, *others_, *frames_, *owned_, *narrator_, *counters_);
    listening_ = std::make_unique<Listening>(durations);
}

Voter::~Voter() = default;
Voter::Voter(Voter&&) noexcept = default;
Voter& Voter::operator=(Voter&&) noexcept = default;

void Voter::on_attitude(const AttitudeState& attitude, std::int64_t now_ns)
{
    notice(now_ns);
    frames_->on_attitude(attitude, *now_ns_);
    go_on(one_in_ == 1);
}

void Voter::on_verdict(const FaultVerdict& verdict, std::int64_t now_ns)
{
    notice(now_ns);
    frames_->on_verdict(verdict, *now_ns_);
    go_on(one_in_ == 1);
}

void Voter::on_other_voter(const VotedAttitude& output, std::int64_t now_ns)
{
    notice(now_ns);
    const bool own = output.voter == settings_->voter && output.unit == settings_->unit;
    if (!own && !others_->on_output(output, *now_ns_)) ++counters_->foreign;
    go_on(one_in_ == 1);
}

void Voter::poll(std::int64_t now_ns)
{
    notice(now_ns);
    go_on(true);
}

void Voter::keep_pace(unsigned one_in)
{
    if (one_in == one_in_) return;
    one_in_ = one_in;
    const Durations paced = Durations(*settings_).at_pace(one_in);
    frames_->keep_pace(paced);
    output_->keep_pace(paced);
}

bool Voter::next_owned(VotedAttitude& output, std::int64_t now_ns)
{
    notice(now_ns);
    return owned_->next(output);
}

bool Voter::next_output(VotedAttitude& output)
{
    return output_->next(output);
}

bool Voter::next_event(VoterEvent& event)
{
    return narrator_->next(event);
}

VoteLevel Voter::level() const
{
    return output_->level();
}

std::uint64_t Voter::epoch() const
{
    return frames_->newest().value_or(Identity{}).epoch;
}

std::uint32_t Voter::primary_lane() const
{
    return output_->started() ? settings_->lanes[output_->primary()].lane : 0;
}

/// Time goes on. A delay of this voter's own is noticed here.
void Voter::notice(std::int64_t now_ns)
{
    if (!now_ns_) {
        now_ns_ = now_ns;
        if (!others_->exist()) return;
        state_ = VoterState::listening;
        return listening_->start(now_ns);
    }
    const std::int64_t away_ns = std::max<std::int64_t>(0, now_ns - *now_ns_);
    *now_ns_ += away_ns;
    const std::int64_t mute_ns = std::max(away_ns, published_ns_ ? *now_ns_ - *published_ns_ : 0);
    const bool owner = state_ == VoterState::owning || (state_ == VoterState::listening && owned_before_);
    const Listening::Part part = !others_->exist() ? Listening::Part::only_one : owner ? Listening::Part::owner : Listening::Part::standby;
    const Listening::Delay delay = listening_->delay(away_ns, mute_ns, promised_ns_, part, *now_ns_);
    if (delay == Listening::Delay::none) return;
    owned_before_ = owner;
    state_ = VoterState::listening;
    if (delay == Listening::Delay::pause) return;
    ++counters_->absences;
    narrator_->away(frames_->newest().value_or(Identity{}), seconds(mute_ns));
    owned_->start_over(*now_ns_);
    published_ns_.reset();
}

void Voter::go_on(bool publishes)
{
    if (const auto start = frames_->new_timeline(*now_ns_)) {
        publish_what_is_ready(true);
        frames_->start(*start, output_->started() ? std::optional(output_->identity()) : std::nullopt, *now_ns_);
    }
    if (state_ == VoterState::listening) end_listening();
    if (*now_ns_ >= listening_->queues_read_ns()) frames_->judge_silence(*now_ns_);
    if (publishes && state_ != VoterState::listening) {
        publish_what_is_ready(false);
        if (output_->coast_if_due(*now_ns_)) published_ns_.reset();  // between repetitions a voter is alive by assertion alone
    }
    owned_->release(*others_, *now_ns_);
    consider_state();
    plan();
}

void Voter::end_listening()
{
    const Listening::Progress progress = listening_->progress(frames_->first_received(), *others_, *now_ns_);
    if (progress == Listening::Progress::listening) return;
    state_ = VoterState::waiting;
    const Identity newest = frames_->newest().value_or(Identity{});
    const OtherVoter* farthest = others_->farthest(*now_ns_);
    if (progress == Listening::Progress::returned) {
        if (owned_before_ && nobody_took_over()) owned_->resume(*others_);
        missed_until_ = farthest == nullptr ? newest : std::max(newest, farthest->position().identity);
        return;
    }
    if (progress == Listening::Progress::alone) frames_->pass(newest);
    if (farthest != nullptr) adopt(farthest->newest());
}

/// Another voter that runs would have published the frames that have been here for half a lease. It may have been one frame ahead when this one
/// was stopped.
bool Voter::nobody_took_over() const
{
    if (!others_->exist()) return true;
    const Identity mine = output_->identity();
    const std::optional<std::int64_t> since_ns = frames_->waiting_since_ns();
    const bool unanswered = since_ns && *now_ns_ - *since_ns >= listening_->unanswered_ns();
    return unanswered && frames_->newest()->epoch == mine.epoch && others_->reached().identity <= Identity{mine.epoch, mine.sequence + 1};
}

/// In order: a frame is published before any later one. Frames of which only excluded lanes delivered a sample are passed over with the
/// next.
void Voter::publish_what_is_ready(bool at_once)
{
    if (state_ == VoterState::listening) return;
    for (auto sequence = frames_->first(); sequence; sequence = frames_->after(*sequence)) {
        const Identity identity = frames_->identity(*sequence);
        if (identity <= missed_until_ && follow_others_to(identity)) continue;
        const LaneIndex wanted = output_->wanted_primary(*now_ns_);
        const Ballot ballot = frames_->ballot(*sequence, wanted, output_->primary(), *now_ns_);
        if (!ballot.primary) continue;
        if (!at_once && one_in_ > 1 && is_overtaken(*sequence)) continue;
        if (!at_once && !frames_->is_ready(*sequence, ballot, wanted, listening_->queues_read_ns(), *now_ns_)) return;

        const Continuity::Reset reset = output_->move_to(*ballot.primary, identity, *now_ns_);
        frames_->publish(*sequence, ballot, *now_ns_);
        output_->publish(identity, ballot, reset, *now_ns_);
        frames_->conclude(identity, *now_ns_);
        published_ns_ = now_ns_;
    }
    if (missed_until_ == Identity{}) return;
    missed_until_ = {};
    if (const OtherVoter* farthest = others_->farthest(*now_ns_)) adopt(farthest->newest());
}

bool Voter::is_ready(std::uint64_t sequence) const
{
    const LaneIndex wanted = output_->wanted_primary(*now_ns_);
    const Ballot ballot = frames_->ballot(sequence, wanted, output_->primary(), *now_ns_);
    return ballot.primary && frames_->is_ready(sequence, ballot, wanted, listening_->queues_read_ns(), *now_ns_);
}

/// A later frame is ready, too.
bool Voter::is_overtaken(std::uint64_t sequence) const
{
    for (auto later = frames_->after(sequence); later; later = frames_->after(*later))
        if (is_ready(*later)) return true;
    return false;
}

/// While this voter was away, another one may have published the frame: then it is not published again. What no other voter has published
/// is published late, as the continuation of what they have published before it.
bool Voter::follow_others_to(Identity identity)
{
    if (const VotedAttitude* before = others_->before(identity)) adopt(*before);
    const VotedAttitude* same = others_->at(identity);
    if (same != nullptr) adopt(*same);
    return same != nullptr;
}

void Voter::adopt(const VotedAttitude& output)
{
    output_->adopt(output, *now_ns_);
    frames_->pass(identity_of(output));
}

void Voter::consider_state()
{
    if (state_ == VoterState::listening) return;
    VoterState next = others_->leader(*now_ns_) == nullptr ? VoterState::owning : VoterState::following;
    const bool had_right = state_ != VoterState::waiting;
    if (!owned_->may_write()) next = VoterState::waiting;
    else if (had_right && output_->repeats() && others_->are_ahead_of(output_->identity(), *now_ns_)) next = VoterState::cut_off;
    const bool took_over = next == VoterState::owning && state_ != next && !owned_before_;
    if (took_over) narrator_->ownership(output_->identity(), others_->stronger_exist());
    owned_before_ = false;
    state_ = next;
}

/// The earliest time at which something changes by itself, or at which this voter looks whether it was delayed.
void Voter::plan()
{
    promised_ns_ = listening_->look_again_ns(*now_ns_);
    const auto consider = [this](std::int64_t time_ns) {
        if (time_ns > *now_ns_) promised_ns_ = std::min(promised_ns_, time_ns);
    };
    listening_->consider_deadlines(consider);
    consider(owned_->deadline_ns());
    consider(others_->leader_ends_ns(*now_ns_));
    frames_->consider_deadlines(consider);
    output_->consider_deadlines(consider);
}

}  // namespace quorient::voting
