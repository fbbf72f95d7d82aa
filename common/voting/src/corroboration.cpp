#include "corroboration.hpp"

#include "quorient/messages/codes.hpp"
#include "quorient/messages/left_out.hpp"
#include "quorient/messages/meaning.hpp"
#include "timeline.hpp"

#include <algorithm>

namespace quorient::voting {
namespace {

AxisMask candidates(const FaultVerdict& verdict)
{
    AxisMask axes = 0;
    const std::size_t count = std::min<std::size_t>(verdict.candidate_count, max_candidates);
    for (std::size_t set = 0; set < count; ++set) axes |= verdict.candidate_set[set];
    return axes;
}

bool sees_trouble(const FaultVerdict& verdict)
{
    const auto state = state_of(verdict);
    return state == VerdictState::suspect || state == VerdictState::ambiguous || state == VerdictState::provisional;
}

bool is_tested(const FaultVerdict& verdict)
{
    return state_of(verdict) != VerdictState::unknown && state_of(verdict) != VerdictState::warming_up;
}

}  // namespace

bool Corroboration::on_verdict(std::size_t lane, const FaultVerdict& verdict, Identity newest, std::int64_t now_ns)
{
    Voice& voice = voice_[lane];
    const Identity identity = identity_of(verdict);
    const bool strays = voice.received && voice.identity.epoch != newest.epoch && identity.epoch == newest.epoch;
    if (voice.received && identity <= voice.identity && !strays) return false;
    if (newest.epoch == identity.epoch && identity.sequence > newest.sequence + frame_window) return false;

    const bool trouble = sees_trouble(verdict);
    const AxisMask all = all_axes(max_axes);
    const AxisMask isolated = verdict.isolated_mask & all;
    const AxisMask provisional = left_out_mask(verdict) & ~verdict.isolated_mask & all;
    const bool onset = (trouble && !voice.troubled) || isolated != voice.isolated || (provisional & ~voice.provisional) != 0;
    voice.identity = identity;
    voice.received_ns = now_ns;
    voice.received = true;
    voice.troubled = trouble;
    voice.isolated = isolated;
    voice.provisional = provisional;
    voice.suspected = (verdict.suspect_mask | candidates(verdict)) & all;
    voice.exhausted = is_tested(verdict) && verdict.detectable_remaining == 0;
    if (onset) open(voice, identity, reported(voice, now_ns), now_ns);
    return true;
}

void Corroboration::on_sample(std::size_t lane, const AttitudeState& sample, std::int64_t now_ns)
{
    Voice& voice = voice_[lane];
    const AxisMask all = all_axes(max_axes);
    const AxisMask applied = sample.isolated_mask & all;
    const AxisMask doubted = (sample.suspect_mask | (left_out_mask(sample) & ~sample.isolated_mask)) & all;
    const bool onset = voice.applied != applied || (doubted & ~voice.doubted) != 0;
    voice.applied = applied;
    voice.doubted = doubted;
    if (onset) open(voice, identity_of(sample), voice.applied | voice.doubted, now_ns);
}

void Corroboration::on_published(Identity identity, std::int64_t now_ns)
{
    std::size_t troubled = 0;
    for (std::size_t lane = 0; lane < lanes_; ++lane) troubled += fresh(voice_[lane], now_ns) && voice_[lane].troubled ? 1 : 0;
    if (troubled < majority_) return;
    settle_epoch_ = identity.epoch;
    settle_until_ = identity.sequence + 1 + settle_frames_;
}

AxisMask Corroboration::corroborated(std::int64_t now_ns) const
{
    std::array<std::uint8_t, max_axes> reports{};
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const AxisMask axes = reported(voice_[lane], now_ns);
        for (std::size_t axis = 0; axes >> axis != 0; ++axis)
            reports[axis] = static_cast<std::uint8_t>(reports[axis] + (axes >> axis & 1U));
    }
    AxisMask agreed = 0;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        if (reports[axis] >= majority_) agreed |= axis_bit(axis);
    }
    return agreed;
}

bool Corroboration::speaks(std::size_t lane, std::int64_t now_ns) const
{
    return fresh(voice_[lane], now_ns);
}

bool Corroboration::knows_better(std::size_t lane, AxisMask left_out, std::int64_t now_ns) const
{
    const AxisMask more = (voice_[lane].isolated | voice_[lane].applied) & ~left_out;
    return more != 0 && (more & corroborated(now_ns)) != 0;
}

bool Corroboration::redundancy_exhausted(std::size_t lane) const
{
    return voice_[lane].exhausted;
}

AxisMask Corroboration::reported(const Voice& voice, std::int64_t now_ns) const
{
    const AxisMask suspected = fresh(voice, now_ns) ? voice.suspected | voice.provisional : 0;
    return voice.isolated | voice.applied | voice.doubted | suspected;
}

/// One lane alone can hold off exclusions only once in a while; where its axes are corroborated, at every step it takes.
void Corroboration::open(Voice& voice, Identity identity, AxisMask axes, std::int64_t now_ns)
{
    const bool shared = axes != 0 && (axes & ~corroborated(now_ns)) == 0;
    const bool recently = voice.opened_once && identity.epoch == settle_epoch_ && identity.sequence < voice.opened_at + reopen_frames_;
    if (recently && !shared) return;
    voice.opened_once = true;
    voice.opened_at = identity.sequence;
    const std::uint64_t until = identity.sequence + 1 + settle_frames_;
    settle_until_ = identity.epoch == settle_epoch_ ? std::max(settle_until_, until) : until;
    settle_epoch_ = identity.epoch;
}

}  // namespace quorient::voting
