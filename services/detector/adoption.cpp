#include "adoption.hpp"

#include "quorient/messages/left_out.hpp"
#include "quorient/messages/meaning.hpp"

#include <algorithm>

namespace quorient::detector {

const char* to_string(AdoptionState state)
{
    switch (state) {
        case AdoptionState::restarted:
            return "restarted";
        case AdoptionState::watching:
            return "watching";
        case AdoptionState::missed_frames:
            return "missed_frames";
    }
    return "unknown";
}

void Adoption::on_frame(Identity frame)
{
    const std::uint64_t missing = place_.missing_before(frame);
    if (missing > 0 || frame.epoch != place_.next().epoch) {
        first_missing_ = frame.sequence - missing;
        end_missing_ = frame.sequence;
        if (state_ != AdoptionState::restarted) stop_adopting_all();
    }
    place_ = StreamPlace::behind(frame);
}

void Adoption::on_verdict(const FaultVerdict& verdict)
{
    if (state_ == AdoptionState::restarted && state_of(verdict) != VerdictState::warming_up) stop_adopting_all();
}

void Adoption::stop_adopting_all()
{
    state_ = end_missing_ == 0 ? AdoptionState::watching : AdoptionState::missed_frames;
}

bool Adoption::on_readmission()
{
    const bool was_restarted = state_ == AdoptionState::restarted;
    first_missing_ = end_missing_ = 0;
    stop_adopting_all();
    return was_restarted;
}

bool Adoption::on_lane(const AttitudeState& attitude)
{
    if (state_ != AdoptionState::restarted || attitude.isolated_mask == 0) return false;
    of_lane_ = {attitude.epoch, isolations_of(attitude)};
    return true;
}

bool Adoption::on_voted(const VotedAttitude& voted)
{
    const auto vouched = vouched_exclusions(voted);
    if (state_ != AdoptionState::restarted || !vouched || vouched->mask() == 0) return false;
    of_voters_ = {voted.epoch, *vouched};
    return true;
}

Exclusions Adoption::kept(std::uint64_t epoch) const
{
    Exclusions merged;
    if (state_ != AdoptionState::restarted) return merged;
    for (const Kept* kept : {&of_lane_, &of_voters_}) {
        const Exclusions current = kept->epoch == epoch ? kept->exclusions : kept->exclusions.in_new_epoch();
        for (std::size_t axis = 0; axis < max_axes; ++axis) merged[axis] = std::min(merged[axis], current[axis]);
    }
    return merged;
}

Exclusions Adoption::missed(const VotedAttitude& voted, AxisMask isolated) const
{
    Exclusions missed;
    const auto vouched = vouched_exclusions(voted);
    if (state_ != AdoptionState::missed_frames || !vouched || voted.epoch != place_.next().epoch) return missed;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        const std::uint64_t onset = (*vouched)[axis];
        if (onset == never || has_axis(isolated, axis)) continue;
        // A fault that began shortly before the gap, or shortly after it, was not seen to begin either: the method was warming up.
        if (onset + warm_up_frames_ >= first_missing_ && onset < end_missing_ + warm_up_frames_) missed[axis] = onset;
    }
    return missed;
}

}  // namespace quorient::detector
