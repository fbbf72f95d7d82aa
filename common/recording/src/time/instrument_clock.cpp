#include "quorient/recording/instrument_clock.hpp"

#include "median.hpp"
#include "quorient/messages/time.hpp"
#include "stamps.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr double arrival_stretch_s = 2.0;   // for one earliest arrival
constexpr std::size_t fewest_arrival_stretches = 4;
constexpr std::size_t far_stretches = 10;  // between the two that the second estimate compares
constexpr double ahead_s = 20.0;           // lateness that lasts longer than this looks like lost samples
constexpr double step_back_s = 1.0;        // a stamp so much earlier than the one before, or a minute later, is another clock
constexpr double step_forward_s = 60.0;
constexpr double follow = 0.02;            // share of a remaining difference that the base takes over per sample: the clock drifts

}  // namespace

void PeriodEstimator::add(std::int64_t stamp_ns)
{
    if (!first_ns_) first_ns_ = stamp_ns;
    const double late_s = seconds_of(stamp_ns - *first_ns_) - number_ * guess_s_;
    if (in_stretch_ == 0 || late_s < earliest_.late_s) earliest_ = {number_, late_s};
    ++number_;
    ++in_stretch_;
    if (in_stretch_ * guess_s_ < arrival_stretch_s) return;
    stretches_.push_back(earliest_);
    in_stretch_ = 0;
}

std::optional<double> PeriodEstimator::period_s() const
{
    if (stretches_.size() < fewest_arrival_stretches) return std::nullopt;
    double period_s = guess_s_;
    for (const std::size_t apart : {std::size_t{1}, far_stretches}) {
        std::vector<double> corrections;
        for (std::size_t i = apart; i < stretches_.size(); ++i) {
            const double samples = stretches_[i].number - stretches_[i - apart].number;
            const double later_s = stretches_[i].late_s - stretches_[i - apart].late_s + samples * (guess_s_ - period_s);
            corrections.push_back((later_s - period_s * std::round(later_s / period_s)) / samples);  // whole periods are lost samples
        }
        if (!corrections.empty()) period_s += median(std::move(corrections));
    }
    return period_s;
}

void ArrivalClock::add(std::int64_t stamp_ns)
{
    if (!last_ns_) origin_ns_ = stamp_ns;
    const double step_s = last_ns_ ? seconds_of(stamp_ns - *last_ns_) : 0.0;
    if (step_s < -step_back_s || step_s > step_forward_s) steps_.push_back(number_);
    last_ns_ = stamp_ns;
    const Waiting waiting{number_, stamp_ns, seconds_of(stamp_ns - origin_ns_) - static_cast<double>(number_) * period_s_};
    ++number_;
    waiting_.push_back(waiting);
    while (!minima_.empty() && minima_.back().late_s >= waiting.late_s) minima_.pop_back();
    minima_.push_back(waiting);
}

std::optional<Placement> ArrivalClock::next()
{
    if (waiting_.empty()) return std::nullopt;
    const Waiting first = waiting_.front();
    const bool stepped = !steps_.empty() && steps_.front() == first.number;
    const std::uint64_t step_ahead = steps_.size() > (stepped ? 1U : 0U) ? steps_[stepped ? 1 : 0] : number_;
    const bool seen_ahead = static_cast<double>(step_ahead - first.number) * period_s_ >= ahead_s || step_ahead < number_;
    if (!finished_ && !seen_ahead) return std::nullopt;
    if (stepped) {
        steps_.erase(steps_.begin());
        base_s_.reset();
    }
    // The earliest of those waiting up to a step of the clock. Without a step ahead it is the front of the minima.
    double earliest_s = minima_.front().late_s;
    if (step_ahead < number_) {
        earliest_s = first.late_s;
        for (const Waiting& waiting : waiting_)
            if (waiting.number < step_ahead) earliest_s = std::min(earliest_s, waiting.late_s);
    }
    waiting_.pop_front();
    if (!minima_.empty() && minima_.front().number == first.number) minima_.pop_front();
    return place(first, earliest_s);
}

Placement ArrivalClock::place(const Waiting& waiting, double earliest_s)
{
    Placement placed;
    placed.restarted = !base_s_;
    if (!base_s_) base_s_ = earliest_s;
    const double lost = std::round((earliest_s - *base_s_) / period_s_);
    if (lost > 0) placed.lost = static_cast<std::uint64_t>(lost);
    *base_s_ += lost * period_s_;
    *base_s_ += follow * (earliest_s - *base_s_);
    placed.late_s = waiting.late_s - *base_s_;
    placed.time_ns = waiting.stamp_ns - nanoseconds(placed.late_s);
    return placed;
}

}  // namespace quorient::recording
