#include "skewed/state.hpp"

#include "field/state_rules.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quorient::fdi {
namespace {

/// So many axes always stay in use: with fewer nothing could show that the accusation is wrong.
constexpr std::size_t least_in_use = 4;

}  // namespace

using skewed::AxisParity;

SkewedDetector::State::State(geometry::SensorCluster cluster, const DetectorSettings& settings, const FieldRules& rules)
    : cluster_(std::move(cluster)),
      rules_(rules),
      figures_(figures_of(settings.sensor_class)),
      framing_(cluster_),
      presence_(cluster_.size()),
      start_(cluster_.axes, framing_.interval_s(), figures_),
      saturation_(cluster_),
      comparison_(cluster_.axes, framing_.interval_s(), field::allowed_by(settings, framing_.interval_s()), rules),
      filters_(cluster_.axes, framing_.interval_s(), rules),
      accusations_(cluster_.size(), least_in_use, framing_.interval_s()),
      history_(cluster_.size())
{
}

void SkewedDetector::State::reset()
{
    framing_.reset();
    presence_.reset();
    start_.reset();
    saturation_.reset();
    comparison_.reset();
    accusations_.reset();
    pending_.clear();
    learning_begun_ = false;
    history_.reset();
    for (std::size_t i = 0; i < cluster_.size(); ++i) acquit(i);
    disturbance_ = 0;
    certainty_ = 0;
    disagreement_.reset();
}

void SkewedDetector::State::exclude(AxisMask excluded)
{
    const AxisSet now = AxisSet::of(excluded & cluster_.all());
    for (std::size_t i = 0; i < cluster_.size(); ++i) {
        if (now.has(i) == excluded_.has(i)) continue;
        accusations_.acquit(i);
        history_.begin_again(i);
        if (now.has(i)) {
            accuse(i, Diagnosis::none);
        } else {  // trusted again: a newcomer
            acquit(i);
            start_.forget(i);
        }
    }
    if (now == excluded_) return;
    excluded_ = now;
    pending_.clear();
}

const AxisParity& SkewedDetector::State::parity_of(AxisSet set)
{
    if (!(set == parity_.set())) parity_ = AxisParity(cluster_.axes, set);
    return parity_;
}

unsigned SkewedDetector::State::detectable_remaining() const
{
    const AxisSet delivering = learning_begun_ ? presence_.delivering() : AxisSet::first(cluster_.size());
    return AxisParity(cluster_.axes, delivering - excluded_).redundancy() > 0 ? 1 : 0;
}

std::string_view SkewedDetector::State::reason() const
{
    if (!learning_begun_) return "the first second of four axes is not complete";
    if (comparable().size() < least_in_use) return "fewer than four axes deliver data";
    return {};
}

SkewedDetector::State::AxisSet SkewedDetector::State::comparable() const
{
    AxisSet set = (start_.started() & presence_.delivering()) - excluded_;
    for (std::size_t i = 0; i < cluster_.size(); ++i)
        if (accusations_.named(i)) set.remove(i);
    return set;
}

void SkewedDetector::State::assess(const Measurement& measurement, Assessment& assessment)
{
    assessment = {};
    if (framing_.add(measurement)) advance(framing_.frame());
    report(measurement, assessment);
}

void SkewedDetector::State::advance(const skewed::AxisFrame& frame)
{
    certainty_ = 0;
    if (!frame.follows) {
        pending_.clear();
        if (learning_begun_) comparison_.wander(field::time_between_s(last_sequence_, frame.sequence, cluster_.interval_s));
    }
    last_sequence_ = frame.sequence;
    for (std::size_t i = 0; i < cluster_.size(); ++i)
        if (frame.present.has(i) && presence_.silent_frames(i) > frames_in(field::forgotten_after_s)) start_.forget(i);
    presence_.update(frame.present);
    start_with(frame);
    take_in(frame);
    if (pending_.complete()) compare();
}

/// First seconds that end with this frame.
void SkewedDetector::State::start_with(const skewed::AxisFrame& frame)
{
    const AxisSet ended = start_.add(frame);
    if (ended.empty()) return;
    bool rested = true;
    for (std::size_t i = 0; i < cluster_.size(); ++i) {
        if (!ended.has(i)) continue;
        if (learning_begun_) comparison_.admit(i, start_.rested(i));
        rested = rested && start_.rested(i);
        history_.begin_again(i);
    }
    if (!learning_begun_) {
        learning_from_ = frame.sequence;
        comparison_.begin(rested);
    }
    learning_begun_ = true;
    const auto outside = start_.outside_class();
    if (!rules_.outside_class || !outside) return;
    start_.distrust(*outside);
    name(*outside, 0, Diagnosis::outside_class);
}

void SkewedDetector::State::take_in(const skewed::AxisFrame& frame)
{
    const AxisSet compared = comparable();
    skewed::PerAxis rates{};
    for (std::size_t i = 0; i < cluster_.size(); ++i)
        if (frame.present.has(i)) rates[i] = frame.rate[i] - start_.bias(i);
    const AxisSet with_data = compared & frame.present;
    const AxisParity& of_all = parity_of(with_data);
    saturation_.update(frame, compared, [&](std::size_t axis) { return comparison_.rate_without(axis, rates, of_all, last_rate_); });
    const AxisSet present = with_data - saturation_.blind();
    const AxisParity& parity = parity_of(present);
    if (parity.redundancy() == 0) {
        pending_.clear();
        return;
    }
    Pending& newest = pending_.add();
    newest.frame = frame;
    newest.present = present;
    newest.rates = rates;
    newest.rate = comparison_.rate(rates, parity, last_rate_);
    last_rate_ = newest.rate;
}

bool SkewedDetector::State::may_learn() const
{
    return rules_.learning && history_.count() >= frames_in(field::noise_known_s) && accusations_.calm(history_.count()) &&
           disturbance_ < field::largest_learned_from && comparable().size() > least_in_use;
}

std::uint64_t SkewedDetector::State::frames_in(double seconds) const
{
    return static_cast<std::uint64_t>(std::lround(seconds / framing_.interval_s()));
}

/// The middle one of three frames.
void SkewedDetector::State::compare()
{
    const Pending& now = pending_[1];
    const AxisSet compared = comparable();
    const AxisParity& present = parity_of(compared & now.present);
    if (present.redundancy() == 0) return;
    const field::Motion motion{now.rate, now.rate - pending_[0].rate, pending_[2].rate - now.rate};
    comparison_.add(motion, {.rates = now.rates, .compared = compared, .parity = present, .learns = may_learn()});
    history_.add(now.frame.sequence, compared);
    diagnose();

    if (parity_of(compared).redundancy() == 1) return judge_last_parity();
    judge(filters_.examine(comparison_.sums(), comparison_.allowance(), compared, history_.ages(), history_.count()));
}

/// The accused in the middle one of three frames, against the others.
void SkewedDetector::State::diagnose()
{
    for (std::size_t i = 0; i < cluster_.size(); ++i) {
        if (!accused_[i].fit.begun()) continue;
        if (accusations_.named(i) || excluded_.has(i) || !accusations_.calm(history_.count())) fit(i);
        else acquit(i);
    }
}

void SkewedDetector::State::fit(std::size_t axis)
{
    const Pending& now = pending_[1];
    AxisSet others = comparable() & pending_[0].present & now.present & pending_[2].present;
    others.remove(axis);
    if (!now.frame.present.has(axis) || others.size() < 3) return;
    const AxisParity& parity = parity_of(others);
    if (parity.redundancy() == 0) return;
    const auto rate_in = [&](const Pending& frame) { return comparison_.rate(frame.rates, parity, frame.rate); };
    Accused& accused = accused_[axis];
    accused.fit.add(now.rates[axis], rate_in(now), (rate_in(pending_[2]) - rate_in(pending_[0])) / (2 * framing_.interval_s()));
    if (history_.count() % field::frames_between_diagnoses != 0) return;
    const skewed::Regressors deviations = comparison_.allowance().deviations();
    field::DiagnosisContext context{.rested = start_.rested(axis), .usual_noise = std::sqrt(comparison_.noise().typical()), .reference = {}};
    context.reference << deviations.head<4>(), deviations(skewed::delay_x);
    context.reference *= parity.spread(cluster_.axes.row(static_cast<Eigen::Index>(axis)).transpose());
    accused.diagnosis = field::proved_by(accused.fit, comparison_.allowed(), -start_.bias(axis), context);
    if (accused.diagnosis.kind == Diagnosis::none) accused.diagnosis = field::blamed_for(accused.fit, accused.blamed_for, context);
}

}  // namespace quorient::fdi
