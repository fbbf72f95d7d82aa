#include "field/state.hpp"

#include "field/state_rules.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quorient::fdi {
namespace {

using field::component_count;

/// The bound of learned gains on a structure: what flexes looks like a gain.
constexpr double structure_gain_error = 0.10;

/// So many instruments always stay in use.
constexpr std::size_t least_in_use = 2;

}  // namespace

FieldDetector::State::State(geometry::SensorCluster cluster, const InstrumentArray& array, const DetectorSettings& settings,
                            const FieldRules& rules)
    : cluster_(std::move(cluster)),
      array_(array),
      rules_(rules),
      mount_(settings.mount),
      figures_(figures_of(settings.sensor_class)),
      framing_(cluster_, array_),
      presence_(array_.size()),
      start_(array_.size(), framing_.interval_s(), figures_),
      saturation_(cluster_, framing_.axes()),
      comparison_(array_.size(), framing_.interval_s(), settings.mount, field::allowed_by(settings, framing_.interval_s()), rules),
      filters_(array_.size(), framing_.interval_s(), settings.mount, rules),
      diagnostics_(cluster_, array_, framing_.axes(), comparison_.learning().allowed()),
      history_(array_.size()),
      accusations_(array_.size(), least_in_use, framing_.interval_s())
{
    if (rules_.fast_lane) fast_lane_ = field::FastLane::make(settings, cluster_);
    if (mount_ == Mount::structure) figures_.largest_gain_error = std::max(figures_.largest_gain_error, structure_gain_error);
}

void FieldDetector::State::reset()
{
    framing_.reset();
    presence_.reset();
    start_.reset();
    saturation_.reset();
    comparison_.reset();
    diagnostics_.reset();
    if (fast_lane_) fast_lane_->reset();
    pending_.clear();
    learning_begun_ = false;
    history_.reset();
    accusations_.reset();
    degraded_.fill({});
    limited_.fill({});
    disturbance_ = 0;
    certainty_ = 0;
    disagreement_.reset();
}

void FieldDetector::State::exclude(AxisMask excluded)
{
    excluded_axes_ = excluded & cluster_.all();
    if (fast_lane_) fast_lane_->exclude(excluded_axes_);
    InstrumentSet now;
    for (std::size_t m = 0; m < array_.size(); ++m) {
        now.set(m, (array_[m].mask & excluded_axes_) != 0);
        if (now.has(m) == excluded_.has(m)) continue;
        accusations_.acquit(m);
        history_.begin_again(m);
        if (now.has(m)) {
            diagnostics_.accuse(m, {});
        } else {  // trusted again: a newcomer
            diagnostics_.acquit(m);
            start_.forget(m);
        }
    }
    if (now == excluded_) return;
    excluded_ = now;
    pending_.clear();
    comparison_.learning().centre(comparable());
}

unsigned FieldDetector::State::detectable_remaining() const
{
    const InstrumentSet delivering = learning_begun_ ? presence_.delivering() : InstrumentSet::first(array_.size());
    return (delivering - excluded_).size() >= 2 ? 1 : 0;
}

std::string_view FieldDetector::State::reason() const
{
    if (!learning_begun_) return "the first second of two instruments is not complete";
    if (comparable().size() < 2) return "fewer than two instruments deliver data";
    return {};
}

field::InstrumentSet FieldDetector::State::comparable() const
{
    InstrumentSet set = start_.started() & presence_.delivering();
    set = set - excluded_;
    for (std::size_t m = 0; m < array_.size(); ++m)
        if (accusations_.named(m)) set.remove(m);
    return set;
}

void FieldDetector::State::assess(const Measurement& measurement, Assessment& assessment)
{
    assessment = {};
    if (fast_lane_) fast_lane_->assess(measurement);
    if (framing_.add(measurement)) advance(framing_.frame());
    report(measurement, assessment);
}

void FieldDetector::State::advance(const field::Frame& frame)
{
    certainty_ = 0;
    if (!frame.follows) {
        pending_.clear();
        if (learning_begun_) comparison_.learning().wander(field::time_between_s(last_sequence_, frame.sequence, cluster_.interval_s));
    }
    last_sequence_ = frame.sequence;
    const auto forgotten = static_cast<std::uint64_t>(field::forgotten_after_s / framing_.interval_s());
    for (std::size_t m = 0; m < array_.size(); ++m)
        if (frame.present.has(m) && presence_.silent_frames(m) > forgotten) start_.forget(m);
    presence_.update(frame.present);
    start_with(frame);
    take_in(frame);
    if (pending_.complete()) compare();
    if (fast_lane_) follow_fast_lane();
}

/// First seconds that end with this frame.
void FieldDetector::State::start_with(const field::Frame& frame)
{
    const InstrumentSet ended = start_.add(frame);
    if (ended.empty()) return;
    for (std::size_t m = 0; m < array_.size(); ++m) {
        if (!ended.has(m)) continue;
        if (learning_begun_) comparison_.learning().admit(m, start_.rested(m));
        history_.begin_again(m);
    }
    if (!learning_begun_) {
        learning_from_ = frame.sequence;
        std::size_t first = 0;
        while (!ended.has(first)) ++first;
        comparison_.learning().reset(start_.rested(first));
    }
    learning_begun_ = true;
    const auto& outside = start_.outside_class();
    if (!rules_.outside_class || !outside || comparable().size() < 3) return;
    start_.take_bias_of_others(outside->instrument);
    name(outside->instrument, 0, {outside->component, Diagnosis::outside_class});
}

void FieldDetector::State::take_in(const field::Frame& frame)
{
    const InstrumentSet compared = comparable();
    const InstrumentSet present = compared & frame.present;
    // Two cannot stand in for a third, and the consensus of others would jump.
    if (present.size() < std::clamp<std::size_t>(compared.size(), 2, 3)) {
        pending_.clear();
        return;
    }
    Pending& newest = pending_.add();
    newest.frame = frame;
    newest.present = present;
    newest.rates.setZero();
    for (std::size_t m = 0; m < array_.size(); ++m)
        if (frame.present.has(m))
            newest.rates.col(static_cast<Eigen::Index>(m)) = frame.rate.col(static_cast<Eigen::Index>(m)) - start_.bias(m);
    newest.consensus = comparison_.consensus(newest.rates, present, last_consensus_);
    last_consensus_ = newest.consensus;
}

bool FieldDetector::State::may_learn() const
{
    const bool knows_noise = history_.count() >= frames_in(field::noise_known_s);
    return rules_.learning && knows_noise && accusations_.calm(history_.count()) && disturbance_ < field::largest_learned_from &&
           comparable().size() >= 3;
}

/// The middle one of three frames.
void FieldDetector::State::compare()
{
    const Pending& now = pending_[1];
    const InstrumentSet compared = comparable();
    const InstrumentSet present = compared & now.present;
    if (present.size() < 2) return;
    if (rules_.saturation) limit();

    field::Comparison::Input input{.rates = now.rates, .compared = compared, .present = present, .learns = may_learn()};
    for (std::size_t c = 0; c < component_count; ++c) input.blind[c] = saturation_.is_common() || saturation_.blinds(c);
    comparison_.add({now.consensus, now.consensus - pending_[0].consensus, pending_[2].consensus - now.consensus}, input);
    history_.add(now.frame.sequence, compared);
    diagnose();

    if (compared.size() == 2) {
        comparison_.learning().wander(framing_.interval_s());
        return judge_two(compared);
    }
    if (compared.size() < 3) return;
    judge(filters_.examine(comparison_.sums(), comparison_.slow_sums(), comparison_.learning(), compared, history_.ages(), history_.count()));
}

std::uint64_t FieldDetector::State::frames_in(double seconds) const
{
    return static_cast<std::uint64_t>(std::lround(seconds / framing_.interval_s()));
}

/// The accused in the middle one of three frames, against the others.
void FieldDetector::State::diagnose()
{
    const Pending& now = pending_[1];
    const bool knows_rate = !saturation_.is_common() && !saturation_.blinds(0) && !saturation_.blinds(1) && !saturation_.blinds(2);
    for (std::size_t m = 0; m < array_.size(); ++m) {
        if (!diagnostics_.accused(m)) continue;
        const bool holds = accusations_.named(m) || excluded_.has(m) || !accusations_.calm(history_.count());
        if (!holds) {
            diagnostics_.acquit(m);
            continue;
        }
        InstrumentSet others = comparable() & pending_[0].present & now.present & pending_[2].present;
        others.remove(m);
        if (!knows_rate || !now.frame.present.has(m) || others.empty()) continue;
        const auto rate_in = [&](const Pending& frame) { return comparison_.consensus(frame.rates, others, frame.consensus); };
        const Eigen::Vector3d acceleration = (rate_in(pending_[2]) - rate_in(pending_[0])) / (2 * framing_.interval_s());
        diagnostics_.add(m, now.rates.col(static_cast<Eigen::Index>(m)), rate_in(now), acceleration);
        if (history_.count() % field::frames_between_diagnoses != 0) continue;
        const double usual = std::sqrt(std::max({comparison_.noise().typical(0), comparison_.noise().typical(1), comparison_.noise().typical(2)}));
        const double share = 1 / std::sqrt(static_cast<double>(others.size()));
        diagnostics_.judge(m, -start_.bias(m), {start_.rested(m), usual, comparison_.learning().deviations() * share});
    }
}

AxisMask FieldDetector::State::axes_of(InstrumentSet instruments) const
{
    AxisMask axes = 0;
    for (std::size_t m = 0; m < array_.size(); ++m)
        if (instruments.has(m)) axes |= array_[m].mask;
    return axes;
}

}  // namespace quorient::fdi
