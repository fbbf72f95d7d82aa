#include "quorient/recording/timing.hpp"

#include "stamps.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr std::size_t steps_to_learn = 400;   // steps from which the period is estimated
constexpr double regular_share = 1.5;         // a step beyond so many periods is a gap
constexpr double shortest_share = 0.5;        // a step below so many periods is a late sample's neighbour
constexpr double longest_hold_s = 0.1;        // that a rate can stand for: beyond it the motion in between is not in the log
constexpr double shortest_hole_s = 10.0;         // the logger paused: a log says nothing of what the instrument did then
constexpr double shortest_hole_periods = 20.0;
constexpr double rate_stretch_s = 2.0;
constexpr double same_rate = 0.2;             // relative: a stretch that differs by more has another rate
constexpr std::size_t most_changes = 64;
constexpr double widest_gyro_rad_s = 4500 * 0.017453292519943295;
constexpr std::uint64_t extreme_again = 5;    // times that an axis shows its extreme before it is a limit

/// One axis, from its two sides.
std::optional<Clipping> both(const std::optional<Clipping>& upper, const std::optional<Clipping>& lower)
{
    if (!upper || !lower) return upper ? upper : lower;
    return Clipping{std::max(upper->range_rad_s, lower->range_rad_s), upper->samples + lower->samples, std::min(upper->first_ns, lower->first_ns),
                    std::max(upper->last_ns, lower->last_ns)};
}

}  // namespace

void InstrumentMeter::add(const InstrumentSample& sample)
{
    if (figures_.samples == 0) {
        figures_.first_ns = figures_.last_ns = sample.time_ns;
        kept_since_ns_.fill(sample.time_ns);
        stretch_begin_ns_ = sample.time_ns;
    }
    ++figures_.samples;
    if (before_) judge_stamp(sample);
    figures_.last_ns = std::max(figures_.last_ns, sample.time_ns);
    judge_values(sample);
    count_for_rate(sample.time_ns);
    before_ = sample;
}

void InstrumentMeter::judge_stamp(const InstrumentSample& sample)
{
    std::int64_t step_ns = sample.time_ns - before_->time_ns;
    if (step_ns == 0) ++figures_.duplicates;
    if (step_ns < 0) {
        ++figures_.steps_back;
        return_to_line(sample.time_ns);
    }
    if (step_ns <= 0) return;
    // After a step back the line goes on behind its latest stamp, not behind the odd one.
    const bool behind = before_->time_ns < figures_.last_ns;
    if (behind && sample.time_ns > figures_.last_ns) step_ns = sample.time_ns - figures_.last_ns;
    if (step_ns > longest_step_ns) jump_ = Jump{before_->time_ns, figures_.gaps, figures_.lost, figures_.longest_gap_s, holes_s_};
    if (figures_.period_s > 0) {
        judge_step(step_ns, sample.covered_s);
        return;
    }
    first_steps_ns_.push_back(step_ns);
    first_covered_s_.push_back(sample.covered_s);
    if (first_steps_ns_.size() == steps_to_learn) learn_period();
}

/// Takes a gap back: its stamps were of another epoch, and the line goes on where it was left.
void InstrumentMeter::return_to_line(std::int64_t time_ns)
{
    if (!jump_ || time_ns < jump_->from_ns || time_ns - jump_->from_ns > longest_step_ns) return;
    figures_.gaps = jump_->gaps;
    figures_.lost = jump_->lost;
    figures_.longest_gap_s = jump_->longest_gap_s;
    holes_s_ = jump_->holes_s;
    figures_.last_ns = time_ns;
    jump_.reset();
}

/// The median step, then the mean of those near it: a log's stamps may be rounded to milliseconds.
void InstrumentMeter::learn_period()
{
    if (first_steps_ns_.size() < 2) return;
    auto sorted = first_steps_ns_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    double sum_s = 0;
    double count = 0;
    for (const std::int64_t step_ns : first_steps_ns_) {
        const double share = static_cast<double>(step_ns) / static_cast<double>(*middle);
        if (share < shortest_share || share > regular_share) continue;
        sum_s += seconds_of(step_ns);
        ++count;
    }
    figures_.period_s = count > 0 ? sum_s / count : seconds_of(*middle);
    for (std::size_t i = 0; i < first_steps_ns_.size(); ++i) judge_step(first_steps_ns_[i], first_covered_s_[i]);
}

void InstrumentMeter::judge_step(std::int64_t step_ns, double covered_s)
{
    const double step_s = seconds_of(step_ns);
    const double periods = step_s / figures_.period_s;
    const double stands_for_s = covered_s > 0 ? std::min(covered_s, step_s) : std::min({step_s, regular_share * figures_.period_s, longest_hold_s});
    covered_s_ += stands_for_s;
    if (step_s > std::max(shortest_hole_s, shortest_hole_periods * figures_.period_s)) holes_s_ += step_s - stands_for_s;
    if (periods > regular_share) {
        ++figures_.gaps;
        figures_.lost += static_cast<std::uint64_t>(std::llround(std::min(periods, 1e15))) - 1;
        figures_.longest_gap_s = std::max(figures_.longest_gap_s, step_s);
    } else if (periods >= shortest_share) {
        ++regular_steps_;
        regular_sum_s_ += step_s;
        regular_squares_ += (step_s - figures_.period_s) * (step_s - figures_.period_s);
    }
}

void InstrumentMeter::judge_values(const InstrumentSample& sample)
{
    bool whole = true;
    const auto beyond = [](double rate_rad_s) { return std::isfinite(rate_rad_s) && std::abs(rate_rad_s) > widest_gyro_rad_s; };
    if (std::any_of(sample.rate_rad_s.begin(), sample.rate_rad_s.end(), beyond)) ++figures_.beyond_gyros;
    for (std::size_t k = 0; k < 3; ++k) {
        const double rate = sample.rate_rad_s[k];
        whole = whole && std::isfinite(rate);
        if (!std::isfinite(rate)) continue;
        const double size = std::abs(rate);
        if (size > figures_.largest_rad_s[k]) {
            figures_.largest_rad_s[k] = size;
            figures_.at_extreme[k] = 0;
        }
        if (size == figures_.largest_rad_s[k]) ++figures_.at_extreme[k];
        (rate < 0 ? lower_ends_ : upper_ends_)[k].add(size, sample.time_ns);
        if (before_ && before_->rate_rad_s[k] == rate) {
            if (sample.time_ns != before_->time_ns) ++figures_.repeated[k];
            figures_.longest_repeat_s[k] = std::max(figures_.longest_repeat_s[k], seconds_of(sample.time_ns - kept_since_ns_[k]));
        } else {
            kept_since_ns_[k] = sample.time_ns;
        }
        if (sample.clipped && (*sample.clipped >> k & 1U) != 0) ++figures_.clipped[k];
    }
    if (!whole) ++figures_.not_finite;
    figures_.clipping_logged = figures_.clipping_logged || sample.clipped.has_value();
    if (!std::isfinite(sample.temperature_c)) return;
    figures_.temperature_min_c = std::fmin(figures_.temperature_min_c, sample.temperature_c);
    figures_.temperature_max_c = std::fmax(figures_.temperature_max_c, sample.temperature_c);
}

/// Rates of whole stretches; one with a hole in it gives no rate.
void InstrumentMeter::count_for_rate(std::int64_t time_ns)
{
    const double length_s = seconds_of(time_ns - stretch_begin_ns_);
    const bool hole = before_ && seconds_of(time_ns - before_->time_ns) > 0.25 * rate_stretch_s;
    if (length_s < 0 || hole) {
        stretch_begin_ns_ = time_ns;
        stretch_samples_ = 0;
        return;
    }
    ++stretch_samples_;
    if (length_s < rate_stretch_s) return;
    const double rate_hz = static_cast<double>(stretch_samples_ - 1) / length_s;
    const double from_s = seconds_of(stretch_begin_ns_ - figures_.first_ns);
    const bool other = stretches_.empty() || std::abs(rate_hz / stretches_.back().rate_hz - 1) > same_rate;
    if (other && rate_hz > 0 && stretches_.size() < most_changes) stretches_.push_back({from_s, rate_hz});
    stretch_begin_ns_ = time_ns;
    stretch_samples_ = 1;
}

std::vector<RateChange> InstrumentMeter::rate_changes() const
{
    if (stretches_.size() < 2) return {};
    return {stretches_.begin() + 1, stretches_.end()};
}

InstrumentFigures InstrumentMeter::figures() const
{
    if (figures_.period_s == 0 && first_steps_ns_.size() >= 2) {
        InstrumentMeter learned = *this;
        learned.learn_period();
        return learned.figures();
    }
    InstrumentFigures figures = figures_;
    if (regular_steps_ > 1) {
        const double mean_s = regular_sum_s_ / regular_steps_;
        const double off_s = mean_s - figures.period_s;
        figures.jitter_s = std::sqrt(std::max(0.0, regular_squares_ / regular_steps_ - off_s * off_s));
        figures.period_s = mean_s;
    }
    const double logged_s = figures.duration_s() - holes_s_;
    figures.coverage = logged_s > 0 ? std::min(1.0, covered_s_ / logged_s) : 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (figures.at_extreme[k] < extreme_again) figures.at_extreme[k] = 0;
        figures.range_reached[k] = both(upper_ends_[k].clipping(), lower_ends_[k].clipping());
    }
    return figures;
}

}  // namespace quorient::recording
