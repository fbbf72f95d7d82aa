#include "verdict/verdict_machine.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"

#include <algorithm>
#include <bit>

namespace quorient::fdi {
namespace {

bool lists_rival(const Assessment& assessment, AxisMask named, AxisMask known)
{
    const auto* const end = assessment.candidate.begin() + assessment.candidate_count;
    return std::any_of(assessment.candidate.begin(), end, [&](AxisMask set) {
        const AxisMask further = set & known;
        return further != 0 && further != named && std::popcount(further) <= std::popcount(named);
    });
}

/// One frame of guard costs a little noise; one frame too late costs a contaminated increment.
std::uint64_t guarded(std::uint64_t onset, unsigned guard)
{
    return onset > guard ? onset - guard : 0;
}

}  // namespace

tl::expected<VerdictMachine, std::string> VerdictMachine::make(const VerdictSettings& settings, std::size_t axis_count,
                                                               std::size_t least_axes)
{
    if (axis_count < least_axes || axis_count > max_axes)
        return tl::unexpected("a verdict needs " + std::to_string(least_axes) + " to " + std::to_string(max_axes) + " axes, got " +
                              std::to_string(axis_count));
    if (const auto checked = check(settings); !checked) return tl::unexpected(checked.error());
    return VerdictMachine(settings, axis_count, least_axes);
}

VerdictMachine::VerdictMachine(const VerdictSettings& settings, std::size_t axis_count, std::size_t least_axes)
    : settings_(settings), all_(all_axes(axis_count)), least_axes_(static_cast<int>(least_axes))
{
    verdict_.state = octet(VerdictState::warming_up);
    verdict_.working_mask = all_;
}

const FaultVerdict& VerdictMachine::update(Identity identity, const Assessment& assessment, AxisMask broken)
{
    if (!started_ || identity.epoch > verdict_.epoch) begin_epoch(identity.epoch);
    else if (identity <= identity_of(verdict_)) return verdict_;

    verdict_.sequence = identity.sequence;
    ++frames_;
    const Evidence newest = evidence_of(assessment);
    if (newest.outcome != Outcome::warming_up) remember(newest);
    count_broken(broken & all_ & ~verdict_.isolated_mask);
    if (frames_ > settings_.warm_up_frames) {
        isolate_named(newest, assessment.onset);
        for (std::size_t axis = 0; axis < max_axes; ++axis) {
            const bool often = static_cast<unsigned>(std::popcount(broken_frames_[axis])) >= settings_.confirm_required;
            if (often && (broken_frames_[axis] & 1U) != 0) latch(axis_bit(axis), broken_from_[axis]);
        }
    }
    leave_out(assessment, broken);
    publish(newest, assessment);
    if (!newest.suspicious() && newest.outcome != Outcome::warming_up) first_unexplained_ = identity.sequence + 1;
    return verdict_;
}

void VerdictMachine::adopt(const Exclusions& excluded_from)
{
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        if (excluded_from[axis] == never || !has_axis(all_, axis)) continue;
        const std::uint64_t earliest = std::min(excluded_from[axis], verdict_.excluded_from[axis]);
        latch(axis_bit(axis), earliest);
        verdict_.excluded_from[axis] = earliest;  // it carries its guard already
        verdict_.adopted = 1;
    }
}

AxisMask VerdictMachine::readmit(AxisMask axes)
{
    const AxisMask returning = axes & verdict_.isolated_mask;
    if (returning == 0) return 0;
    verdict_.excluded_from.readmit(returning);
    verdict_.isolated_mask &= ~returning;
    work_with_the_rest();
    drop_evidence();
    return returning;
}

void VerdictMachine::begin_epoch(std::uint64_t epoch)
{
    verdict_.epoch = epoch;
    end_provisional(all_);
    if (started_) verdict_.excluded_from = verdict_.excluded_from.in_new_epoch();
    started_ = true;
    frames_ = 0;
    first_unexplained_ = 0;
    broken_ = 0;
    broken_frames_.fill(0);
    drop_evidence();
}

void VerdictMachine::Evidence::add(AxisMask set)
{
    const auto* const end = explaining.begin() + count;
    if (set == 0 || std::find(explaining.begin(), explaining.begin() + count, set) != end) return;
    if (count < max_candidates) explaining[count++] = set;
    else truncated = true;
}

VerdictMachine::Evidence VerdictMachine::evidence_of(const Assessment& assessment) const
{
    Evidence evidence;
    evidence.outcome = assessment.outcome;
    const AxisMask known = all_ & ~verdict_.isolated_mask;  // an excluded axis explains nothing new
    const AxisMask named = assessment.isolated & known;
    if (assessment.outcome == Outcome::isolated) {
        if (named == 0) return Evidence{};
        evidence.culprit = named;
        evidence.attributed = !lists_rival(assessment, named, known);
        evidence.add(named);
    }
    for (unsigned i = 0; i < assessment.candidate_count; ++i) evidence.add(assessment.candidate[i] & known);
    evidence.truncated |= assessment.candidates_truncated;
    if (assessment.outcome == Outcome::suspect) {
        AxisMask explained = assessment.candidate_count == 0 ? named : 0;
        for (unsigned i = 0; i < evidence.count; ++i) explained |= evidence.explaining[i];
        evidence.culprit = named & explained;
        if (evidence.count == 0) evidence.add(evidence.culprit);
    }
    return evidence;
}

void VerdictMachine::remember(const Evidence& evidence)
{
    window_[window_next_] = evidence;
    window_next_ = (window_next_ + 1) % max_window;
    window_size_ = std::min(window_size_ + 1, settings_.confirm_window);
}

template <class Predicate>
unsigned VerdictMachine::count_in_window(Predicate predicate) const
{
    unsigned count = 0;
    for (unsigned age = 0; age < window_size_; ++age) count += predicate(past(age)) ? 1 : 0;
    return count;
}

void VerdictMachine::isolate_named(const Evidence& newest, std::uint64_t estimated_onset)
{
    if (!newest.attributed) return;
    const AxisMask named = newest.explaining[0];
    const unsigned agreeing = count_in_window([&](const Evidence& e) { return e.attributed && e.explaining[0] == named; });
    if (agreeing < settings_.confirm_required) return;
    latch(named, estimated_onset == never ? first_unexplained_ : std::min(estimated_onset, first_unexplained_));
}

void VerdictMachine::count_broken(AxisMask broken)
{
    const std::uint32_t window = settings_.confirm_window == 32 ? ~0U : (1U << settings_.confirm_window) - 1;
    broken_ = 0;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        auto& frames = broken_frames_[axis];
        if (frames == 0) broken_from_[axis] = verdict_.sequence;
        frames = ((frames << 1) | (has_axis(broken, axis) ? 1U : 0U)) & window;
        if (frames != 0) broken_ |= axis_bit(axis);
    }
}

void VerdictMachine::latch(AxisMask axes, std::uint64_t onset)
{
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        if (!has_axis(axes & ~verdict_.isolated_mask, axis)) continue;
        // What was left out provisionally stays out from where it was.
        verdict_.excluded_from[axis] = std::min(guarded(onset, settings_.onset_guard_frames), verdict_.excluded_from[axis]);
        broken_frames_[axis] = 0;
    }
    broken_ &= ~axes;
    verdict_.isolated_mask |= axes;
    work_with_the_rest();
    drop_evidence();
}

/// What the method wants out, and what proves itself broken in this frame.
void VerdictMachine::leave_out(const Assessment& assessment, AxisMask broken)
{
    const bool can = frames_ > settings_.warm_up_frames;
    const AxisMask asked = can ? (assessment.provisional | broken) & all_ & ~verdict_.isolated_mask : 0;
    const AxisMask left = all_ & ~verdict_.isolated_mask & ~asked;
    const AxisMask out = std::popcount(left) >= least_axes_ ? asked : 0;
    forget_suspicion(provisional_mask(verdict_) & ~asked);
    end_provisional(~out);
    const std::uint64_t from = guarded(std::min(assessment.provisional_from, verdict_.sequence), settings_.onset_guard_frames);
    const AxisMask begins = out & ~provisional_mask(verdict_);
    verdict_.excluded_from.exclude(begins & assessment.provisional, from);
    verdict_.excluded_from.exclude(begins & ~assessment.provisional, verdict_.sequence);
    work_with_the_rest();
}

void VerdictMachine::end_provisional(AxisMask axes)
{
    verdict_.excluded_from.readmit(provisional_mask(verdict_) & axes);
}

/// What was held against axes that return counts no more.
void VerdictMachine::forget_suspicion(AxisMask returning)
{
    for (Evidence& evidence : window_)
        if (evidence.outcome == Outcome::suspect && evidence.culprit != 0 && (evidence.culprit & ~returning) == 0) evidence = {};
}

void VerdictMachine::work_with_the_rest()
{
    verdict_.working_mask = all_ & ~verdict_.isolated_mask & ~provisional_mask(verdict_);
}

const VerdictMachine::Evidence* VerdictMachine::latest_suspicion() const
{
    for (unsigned age = 0; age < window_size_; ++age)
        if (past(age).suspicious()) return &past(age);
    return nullptr;
}

void VerdictMachine::publish(const Evidence& newest, const Assessment& assessment)
{
    verdict_.statistic = assessment.statistic;
    verdict_.threshold = assessment.threshold;
    verdict_.residual = assessment.residual;
    verdict_.bound = assessment.bound;
    verdict_.suspect_mask = broken_;
    verdict_.candidate_count = 0;
    verdict_.candidates_truncated = 0;
    verdict_.candidate_set.fill(0);

    auto state = verdict_.isolated_mask != 0 ? VerdictState::isolated : VerdictState::healthy;
    if (broken_ != 0) state = VerdictState::suspect;
    if (const Evidence* suspicion = latest_suspicion()) state = publish_suspicion(*suspicion);
    if (const AxisMask out = provisional_mask(verdict_); out != 0) {
        state = VerdictState::provisional;
        verdict_.suspect_mask |= out;
    }
    if (assessment.saturated) state = VerdictState::saturated;
    if (std::popcount(verdict_.working_mask) < least_axes_) state = VerdictState::blind;
    const bool learning = newest.outcome == Outcome::warming_up && state == VerdictState::healthy;
    if (learning || frames_ <= settings_.warm_up_frames) state = VerdictState::warming_up;
    verdict_.state = octet(state);
}

VerdictState VerdictMachine::publish_suspicion(const Evidence& suspicion)
{
    Evidence published = suspicion;
    const unsigned suspicious = count_in_window([](const Evidence& e) { return e.suspicious(); });
    const unsigned undecided = count_in_window([](const Evidence& e) { return e.undecided(); });
    const bool explained = suspicion.outcome == Outcome::ambiguous || suspicion.outcome == Outcome::isolated;

    auto state = VerdictState::suspect;
    if (suspicion.undecided() && undecided >= settings_.confirm_required) {
        state = VerdictState::blind;
    } else if (explained && suspicion.count > 0 && suspicious >= settings_.confirm_required) {
        state = VerdictState::ambiguous;  // confirmed frames that do not agree on one name
        for (unsigned age = 0; age < window_size_; ++age)
            if (past(age).attributed) published.add(past(age).explaining[0]);
    }
    verdict_.suspect_mask |= suspicion.culprit;
    verdict_.candidate_count = published.count;
    verdict_.candidates_truncated = published.truncated ? 1 : 0;
    verdict_.candidate_set = published.explaining;
    return state;
}

}  // namespace quorient::fdi
