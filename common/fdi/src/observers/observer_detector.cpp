#include "quorient/fdi/observer_detector.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace quorient::fdi {
namespace {

/// Over a gap of so many frames held samples say nothing any more.
constexpr std::uint64_t longest_gap = 20;

}  // namespace

tl::expected<std::unique_ptr<ObserverDetector>, std::string> ObserverDetector::make(const ObserverSettings& settings, double interval_s,
                                                                                    double margin)
{
    auto bank = ObserverBank::make(settings, interval_s);
    if (!bank) return tl::unexpected(bank.error());
    if (!observer_margin_bounds.hold(margin)) return tl::unexpected(settings::out_of_bounds("margin", observer_margin_bounds, "", margin));
    const auto settling_frames = bank->start(ObserverBank::Outputs::Zero(settings.plant.outputs()), 0);
    std::unique_ptr<ObserverDetector> detector(new ObserverDetector(std::move(*bank), interval_s, margin));
    detector->naming_frames_ = settling_frames;
    return detector;
}

unsigned ObserverDetector::detectable_remaining() const
{
    const AxisMask left = working();
    if (left == 0) return 0;
    if (excluded_ == 0) return 1;
    return bank_.scheme() == ObserverScheme::blind && bank_.find(excluded_) ? 1 : 0;
}

void ObserverDetector::assess(const Measurement& measurement, Assessment& assessment)
{
    assessment = {};
    assessment.threshold = 1;
    if (!read_input(measurement)) {
        assessment.outcome = Outcome::blind;
        place_.reset();
        return;
    }
    follow_to(measurement);
    valid_ = measurement.valid & all_axes(bank_.channels());
    bank_.compare(samples_, valid_);
    if (frames_ < settling_frames_) assessment.outcome = Outcome::warming_up;
    else if (bank_.scheme() == ObserverScheme::directional) judge_directional(measurement.identity.sequence, assessment);
    else judge_blind(assessment);
    if (bank_.scheme() == ObserverScheme::blind && frames_ < naming_frames_) withhold_names(assessment);
    bank_.advance(input_);
    place_ = StreamPlace::behind(measurement.identity);
    ++frames_;
}

bool ObserverDetector::read_input(const Measurement& measurement)
{
    if (measurement.known_input.size() < bank_.inputs()) return false;
    input_.resize(static_cast<Eigen::Index>(bank_.inputs()));
    for (Eigen::Index input = 0; input < input_.size(); ++input) input_(input) = measurement.known_input[static_cast<std::size_t>(input)];
    return input_.allFinite();
}

/// Brings the observers to this frame; frames that are missing are bridged with what was last known.
void ObserverDetector::follow_to(const Measurement& measurement)
{
    samples_.setZero(static_cast<Eigen::Index>(bank_.channels()));
    for (Eigen::Index channel = 0; channel < samples_.size(); ++channel) {
        const auto axis = static_cast<std::size_t>(channel);
        if (has_axis(measurement.valid, axis)) samples_(channel) = measurement.increment[axis] / measurement.interval_s;
    }
    const bool same_epoch = place_ && measurement.identity.epoch == place_->next().epoch;
    const std::uint64_t missing = same_epoch ? place_->missing_before(measurement.identity) : longest_gap;
    if (missing >= longest_gap) {
        settling_frames_ = bank_.start(samples_, measurement.valid & working());
        frames_ = alarm_frames_ = 0;
        return;
    }
    for (std::uint64_t bridged = 0; bridged < missing; ++bridged) {
        bank_.compare(samples_, 0);
        bank_.advance(input_);
    }
}

void ObserverDetector::judge_directional(std::uint64_t sequence, Assessment& assessment)
{
    assessment.outcome = Outcome::healthy;
    if (excluded_ != 0) {  // both observers use both channels: nothing can be compared any more
        alarm_frames_ = 0;
        return;
    }
    double best = 0;
    std::size_t channel = 0;
    for (std::size_t observer = 0; observer < bank_.size(); ++observer) {
        const double ratio = bank_.metric(observer) / bank_.metric_limit(observer);
        if (ratio <= best) continue;
        best = ratio;
        channel = observer;
    }
    report(channel, interval_s_, assessment);
    assessment.statistic = best;
    if (best <= 1) {
        alarm_frames_ -= alarm_frames_ > 0 ? 1 : 0;
        return;
    }
    // Metrics may pass 0 on their way to their direction: the onset is where the alarms began, not where they went on.
    if (alarm_frames_ == 0) alarm_since_ = sequence;
    alarm_frames_ = std::min(alarm_frames_ + 1, bank_.attribution_frames() + 1);
    assessment.outcome = alarm_frames_ > bank_.attribution_frames() ? Outcome::isolated : Outcome::suspect;
    if (assessment.outcome == Outcome::suspect) return;
    assessment.isolated = axis_bit(channel);
    assessment.onset = alarm_since_;
    const std::size_t other = 1 - channel;
    const double rival = bank_.metric(other) / bank_.metric_limit(other);
    if (rival <= 1 || rival * margin_ <= best) return;
    assessment.outcome = Outcome::ambiguous;
    assessment.isolated = 0;
    assessment.add_candidate(axis_bit(channel));
    assessment.add_candidate(axis_bit(other));
}

void ObserverDetector::judge_blind(Assessment& assessment) const
{
    const AxisMask left = working();
    if (std::popcount(left) < 2) {
        judge_last(left, assessment);
        return;
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t channel = 0; channel < bank_.channels(); ++channel) {
        const auto observer = bank_.find(excluded_ | axis_bit(channel));
        if (!has_axis(left, channel) || !observer) continue;
        const double ratio = worst(*observer, left & ~axis_bit(channel));
        assessment.statistic = std::max(assessment.statistic, ratio);
        if (ratio <= 1) assessment.add_candidate(axis_bit(channel));
        if (ratio >= least) continue;
        least = ratio;
        report(*observer, interval_s_, assessment);
    }
    if (assessment.statistic <= 1) {
        assessment.outcome = Outcome::healthy;
        assessment.candidate_count = 0;
        return;
    }
    for (std::size_t i = 0; assessment.candidate_count == 0 && i < bank_.channels(); ++i) {
        for (std::size_t j = i + 1; j < bank_.channels(); ++j) {
            const AxisMask pair = axis_bit(i) | axis_bit(j);
            const auto observer = excluded_ == 0 ? bank_.find(pair) : std::nullopt;
            if (observer && std::popcount(left) > 3 && worst(*observer, left & ~pair) <= 1) assessment.add_candidate(pair);
        }
    }
    assessment.outcome = assessment.candidate_count == 0   ? Outcome::blind
                         : assessment.candidate_count == 1 ? Outcome::isolated
                                                           : Outcome::ambiguous;
    if (assessment.outcome != Outcome::isolated) return;
    assessment.isolated = assessment.candidate[0];
    assessment.candidate_count = 0;
}

void ObserverDetector::withhold_names(Assessment& assessment)
{
    if (assessment.outcome == Outcome::healthy || assessment.outcome == Outcome::warming_up) return;
    assessment.outcome = Outcome::suspect;
    assessment.isolated = 0;
    assessment.candidate_count = 0;
}

/// One channel is left: the model alone can contradict it.
void ObserverDetector::judge_last(AxisMask left, Assessment& assessment) const
{
    const auto observer = bank_.find(excluded_);
    assessment.outcome = left == 0 || !observer ? Outcome::blind : Outcome::healthy;
    if (assessment.outcome == Outcome::blind) return;
    report(*observer, interval_s_, assessment);
    assessment.statistic = worst(*observer, left);
    if (assessment.statistic <= 1) return;
    assessment.outcome = Outcome::isolated;
    assessment.isolated = left;
}

std::optional<Expectation> ObserverDetector::expectation(std::size_t channel) const
{
    const auto row = static_cast<Eigen::Index>(channel);
    if (!settled() || !has_axis(valid_, channel)) return std::nullopt;
    const AxisMask others = excluded_ & ~axis_bit(channel);
    if (bank_.scheme() == ObserverScheme::directional) {
        bool quiet = others == 0;
        for (std::size_t observer = 0; observer < bank_.size(); ++observer)
            quiet = quiet && bank_.metric(observer) <= bank_.metric_limit(observer);
        return Expectation{(samples_(row) - bank_.residual(channel)(row)) * interval_s_, quiet};
    }
    const auto without = bank_.find(others | axis_bit(channel));
    const auto observer = without ? without : bank_.find(others);
    if (!observer) return std::nullopt;
    return Expectation{(samples_(row) - bank_.residual(*observer)(row)) * interval_s_, agrees_with(working() | axis_bit(channel), others)};
}

/// Nothing that the observers without `excluded` (and one more channel) see contradicts the trusted channels.
bool ObserverDetector::agrees_with(AxisMask trusted, AxisMask excluded) const
{
    if (const auto all_trusted = bank_.find(excluded); all_trusted && worst(*all_trusted, trusted) > 1) return false;
    for (std::size_t channel = 0; channel < bank_.channels(); ++channel) {
        const auto observer = bank_.find(excluded | axis_bit(channel));
        if (has_axis(trusted, channel) && observer && worst(*observer, trusted) > 1) return false;
    }
    return true;
}

std::string_view ObserverDetector::reason() const
{
    if (!place_) return "the known input is missing, and nothing can be expected without it";
    return settled() ? std::string_view{} : "the observers settle: the samples do not determine the whole state";
}

double ObserverDetector::worst(std::size_t observer, AxisMask channels) const
{
    double ratio = 0;
    for (std::size_t channel = 0; channel < bank_.channels(); ++channel) {
        if (!has_axis(channels, channel)) continue;
        const auto row = static_cast<Eigen::Index>(channel);
        ratio = std::max(ratio, std::abs(bank_.residual(observer)(row)) / bank_.limit(observer)(row));
    }
    return ratio;
}

void ObserverDetector::report(std::size_t observer, double interval_s, Assessment& assessment) const
{
    for (std::size_t channel = 0; channel < bank_.channels(); ++channel) {
        const auto row = static_cast<Eigen::Index>(channel);
        assessment.residual[channel] = bank_.residual(observer)(row) * interval_s;
        assessment.bound[channel] = bank_.limit(observer)(row) * interval_s;
    }
}

}  // namespace quorient::fdi
