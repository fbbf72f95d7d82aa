#include "output.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/time.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quorient::voting {
namespace {

/// A primary that the stronger voter names in so many frames running is its choice; in fewer it may stand in for a late one.
constexpr std::uint64_t choice_frames = 5;

}  // namespace

Output::Output(const VoterSettings& settings, const Durations& durations, const OtherVoters& others, Frames& frames, OwnedStream& owned,
               Narrator& narrator, VoterCounters& counters)
    : settings_(settings), durations_(durations), others_(others), frames_(frames), owned_(owned), narrator_(narrator), counters_(counters)
{
}

/// What the other voter only repeats is as old as this voter knows, and lost if that one says so.
void Output::adopt(const VotedAttitude& output, std::int64_t now_ns)
{
    if (started() && identity_of(output) <= identity()) return;
    continuity_.follow(output);
    primary_ = frames_.lane_of(output.primary_lane).value_or(primary_);
    last_ = output;
    const bool lost = mode_of(output) == AttitudeMode::lost;
    frame_ns_ = lost ? now_ns - durations_.silence_ns - durations_.coasting_to_lost_ns : now_ns;
}

LaneIndex Output::wanted_primary(std::int64_t now_ns) const
{
    const OtherVoter* leader = others_.leader(now_ns);
    const auto choice = leader == nullptr ? std::nullopt : leader->steady_primary(choice_frames);
    const auto lane = choice ? frames_.lane_of(*choice) : std::nullopt;
    return lane && !frames_.lane(*lane).blocked() ? *lane : primary_;
}

Continuity::Reset Output::move_to(LaneIndex lane, Identity identity, std::int64_t now_ns)
{
    const AttitudeState& sample = *frames_.lane(lane).at(identity);
    const OtherVoter* leader = others_.leader(now_ns);
    const VotedAttitude* before = leader == nullptr ? nullptr : leader->before(identity);
    if (before != nullptr && (!started() || identity_of(*before) >= this->identity())) continuity_.follow(*before);
    Continuity::Reset reset = continuity_.next(sample, frames_.lane(lane).at(continuity_.identity()));
    const VotedAttitude* same = leader == nullptr ? nullptr : leader->at(identity);
    if (same != nullptr && Continuity::is_same(same->attitude, sample.attitude)) {
        reset.counter = same->reset_counter;
        reset.rotation = same->reset_rotation;
    }
    if (lane == primary_ || stands_in(lane, identity, now_ns)) return reset;
    if (started()) {
        changes_[counters_.primary_changes++ % changes_.size()] = counters_.published;
        const auto recent = std::count_if(changes_.begin(), changes_.end(), [this](std::uint64_t at) {
            return at != 0 && counters_.published - at < settings_.return_frames;
        });
        narrator_.primary_changed(identity, primary_, lane, reason_to_leave(identity, lane, now_ns),
                                  reset.moved ? angle_between(reset.rotation, no_rotation) : 0, static_cast<unsigned>(recent));
    }
    primary_ = lane;
    return reset;
}

/// The wanted primary is only late: another lane's sample is published for this frame, until that one is silent.
bool Output::stands_in(LaneIndex lane, Identity identity, std::int64_t now_ns) const
{
    const LaneIndex wanted = wanted_primary(now_ns);
    return started() && lane != wanted && !frames_.lane(wanted).blocked() && frames_.lane(wanted).at(identity) == nullptr;
}

const char* Output::reason_to_leave(Identity identity, LaneIndex to, std::int64_t now_ns) const
{
    const OtherVoter* leader = others_.leader(now_ns);
    const LaneTracker& lane = frames_.lane(primary_);
    if (lane.latched() == LaneExclusion::silent) return "it is silent";
    if (lane.blocked()) return "it is excluded";
    if (leader != nullptr && leader->newest().primary_lane == settings_.lanes[to].lane) return "the stronger voter chose so";
    const AttitudeState* sample = lane.at(identity);
    if (sample == nullptr) return "its sample of this frame did not come in time";
    if (!is_countable(*sample)) return "it is initialising";
    if (sample->isolated_mask != frames_.lane(to).at(identity)->isolated_mask) return "the detectors stand behind other axes";
    return "the majority contradicts it";
}

void Output::publish(Identity identity, const Ballot& ballot, const Continuity::Reset& reset, std::int64_t now_ns)
{
    if (last_.epoch == identity.epoch && identity.sequence > last_.sequence + 1) counters_.gaps += identity.sequence - last_.sequence - 1;
    const AttitudeState& sample = *frames_.lane(*ballot.primary).at(identity);
    set_level(mode_of(sample) == AttitudeMode::lost ? VoteLevel::lost : frames_.level(primary_), identity);
    last_ = filled(sample, ballot, reset);
    frame_ns_ = now_ns;
    continuity_.follow(last_);
    emit(last_, false, now_ns);
}

VotedAttitude Output::filled(const AttitudeState& sample, const Ballot& ballot, const Continuity::Reset& reset) const
{
    VotedAttitude output;
    output.epoch = sample.epoch;
    output.sequence = sample.sequence;
    output.sample_time_ns = sample.sample_time_ns;
    output.output_sequence = others_.next_output_sequence(identity_of(sample), own_sequence_);
    output.attitude = sample.attitude;
    output.reset_rotation = reset.rotation;
    output.reset_counter = reset.counter;
    output.rate_rad_s = sample.rate_rad_s;
    output.angle_sigma_rad = sample.angle_sigma_rad;
    output.spread_rad = ballot.spread_rad;
    output.excluded_from = sample.excluded_from;
    output.stamp_ns = sample.stamp_ns;
    output.unit = settings_.unit;
    output.voter = settings_.voter;
    output.primary_lane = sample.lane;
    output.excluded_mask = frames_.excluded();
    output.vouching_mask = ballot.vouching | (frames_.standing() & ~ballot.sampled & ~output.excluded_mask);
    output.used_mask = sample.used_mask;
    output.isolated_mask = sample.isolated_mask;
    output.suspect_mask = sample.suspect_mask;
    for (LaneIndex lane = 0; lane < frames_.lanes(); ++lane) output.excluded_why[lane] = octet(frames_.lane(lane).why());
    output.mode = sample.mode;
    output.level = octet(level_);
    output.seeded = sample.seeded;
    output.bridged = sample.bridged;
    return output;
}

bool Output::coast_if_due(std::int64_t now_ns)
{
    if (!started() || now_ns - frame_ns_ < durations_.silence_ns) return false;
    if (repeats() && now_ns - repeated_ns_ < durations_.coasting_interval_ns) return false;
    repeated_ns_ = now_ns;
    const bool lost = now_ns - frame_ns_ >= durations_.silence_ns + durations_.coasting_to_lost_ns;
    if (lost) frames_.forget_levels();
    set_level(lost ? VoteLevel::lost : VoteLevel::coasting, identity_of(last_));

    VotedAttitude output = last_;
    const double rate_rad_s = std::hypot(last_.rate_rad_s[0], last_.rate_rad_s[1], last_.rate_rad_s[2]) + settings_.coasting_rate_rad_s;
    output.angle_sigma_rad = std::min(std::numbers::pi, last_.angle_sigma_rad + rate_rad_s * seconds(now_ns - frame_ns_));
    output.voter = settings_.voter;
    output.output_sequence = others_.next_output_sequence(identity_of(last_), own_sequence_);
    output.mode = octet(lost ? AttitudeMode::lost : AttitudeMode::coasting);
    output.level = octet(level_);
    output.vouching_mask = 0;
    output.spread_rad = 0;
    emit(output, true, now_ns);
    return true;
}

void Output::emit(const VotedAttitude& output, bool repeated, std::int64_t now_ns)
{
    outputs_.push() = output;
    own_sequence_ = output.output_sequence;
    owned_.push(output, repeated, now_ns);
    ++counters_.published;
}

void Output::set_level(VoteLevel level, Identity identity)
{
    if (level == level_) return;
    narrator_.level(identity, level_, level, frames_.standing() & ~frames_.excluded());
    level_ = level;
}

}  // namespace quorient::voting
