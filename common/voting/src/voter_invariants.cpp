// What must hold within a voter after every call. Tests ask for it; nothing here runs in a process.

#include "frames.hpp"
#include "listening.hpp"
#include "other_voters.hpp"
#include "output.hpp"
#include "owned_stream.hpp"
#include "quorient/voting/voter.hpp"

#include <algorithm>

namespace quorient::voting {
namespace {

const char* broken_outcome(const Ballot& ballot)
{
    if (!ballot.primary) return "a frame was published without a primary";
    if (!has_lane(ballot.sampled, *ballot.primary)) return "the primary of a published frame has no sample of it";
    if (!has_lane(ballot.agreeing, *ballot.primary)) return "a primary does not agree with itself";
    if ((ballot.vouching & ~ballot.agreeing) != 0) return "a lane vouches and does not agree";
    if ((ballot.agreeing & ~ballot.sampled) != 0) return "a lane agrees and has no sample";
    if ((ballot.seeded & ~ballot.sampled) != 0) return "a lane is seeded and has no sample";
    if ((ballot.isolated & ~ballot.left_out) != 0) return "the primary uses an axis that its group has isolated";
    return nullptr;
}

}  // namespace

const char* LaneBoard::broken_invariant() const
{
    const std::uint64_t count = std::min<std::uint64_t>(published_, remembered);
    for (std::uint64_t age = 0; age < count; ++age) {
        const Record& made = record(age);
        if (const char* broken = broken_outcome(made.ballot)) return broken;
        if (age > 0 && made.identity >= record(age - 1).identity) return "published frames are not in order";
        if (made.open != (age < close_after_)) return "conclusions were drawn too early, or not at all";
    }
    if ((levels_.standing() & ~all_axes(lanes_.size())) != 0) return "a lane that does not exist stands behind the output";
    return nullptr;
}

const char* OtherVoter::broken_invariant() const
{
    if (!seen_) return nullptr;
    if (position_of(newest()) != newest_) return "another voter's newest output is not where it is looked for";
    const bool newer =
        std::any_of(output_.begin(), output_.end(), [this](const VotedAttitude& output) { return position_of(output) > newest_; });
    return newer ? "another voter has an output newer than its newest" : nullptr;
}

const char* OtherVoters::broken_invariant() const
{
    for (const OtherVoter& other : others_) {
        if (const char* broken = other.broken_invariant()) return broken;
        if (other.seen() && other.position() > reached_) return "a voter is farther than all have reached";
    }
    return nullptr;
}

const char* OwnedStream::broken_invariant() const
{
    if (right_ != Right::proving && good_frames_ < good_frames_required_) return "the right to write came before enough good frames";
    if (right_ == Right::proving && held_ != 0) return "frames are held back without the right to write";
    if (listened_ < good_frames_) return "more good frames than frames";
    for (std::size_t i = 1; i < waiting_.size(); ++i)
        if (waiting_[i].output.output_sequence <= waiting_[i - 1].output.output_sequence) return "outputs that wait are not in order";
    for (std::size_t i = 0; i < ready_.size(); ++i)
        if (identity_of(ready_[i]) > written_.identity) return "an output was written, and is not remembered as written";
    return nullptr;
}

const char* Output::broken_invariant() const
{
    if (started() && identity_of(last_) != identity()) return "what is repeated is not the newest frame of the stream";
    if (primary_ >= frames_.lanes()) return "the primary is no lane";
    if (own_sequence_ != 0 && level_ == VoteLevel::unknown) return "an output was published without a level";
    if (own_sequence_ != 0 && counters_.published == 0) return "an output was published and not counted";
    return nullptr;
}

const char* Voter::broken_invariant() const
{
    if (const char* broken = others_->broken_invariant()) return broken;
    if (const char* broken = frames_->broken_invariant()) return broken;
    if (const char* broken = owned_->broken_invariant()) return broken;
    if (const char* broken = output_->broken_invariant()) return broken;
    if (!now_ns_) return nullptr;
    if (promised_ns_ <= *now_ns_) return "the next deadline is in the past";
    if (published_ns_ && *published_ns_ > *now_ns_) return "a frame was published in the future";
    if (may_own() && !owned_->may_write()) return "it may own `voted` without the right to write";
    const bool led = others_->leader(*now_ns_) != nullptr;
    if (state_ == VoterState::owning && led) return "it owns `voted` while a stronger voter is fresh";
    if (state_ == VoterState::following && !led) return "it follows, and there is no stronger voter";
    if (state_ == VoterState::cut_off && !output_->repeats()) return "it is cut off and publishes frames";
    const auto first = frames_->first();
    if (first && output_->started() && frames_->identity(*first) <= output_->identity())
        return "a frame of the past may still be published";
    return nullptr;
}

}  // namespace quorient::voting
