#include "quorient/recording/resampler.hpp"

#include "quorient/messages/time.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr double longest_hold = 1.7;      // periods that a rate holds: a sample that comes 70 % late is not a missing one
constexpr double bridged = 0.3;           // periods between what two samples cover that are rounding
constexpr double uncovered_share = 0.02;  // share of an interval that may lack samples
constexpr std::int64_t uncovered_rounding_ns = 2000;
constexpr double longest_gap_s = 10.0;    // without any sample: frames go on behind it

}  // namespace

Resampler::Resampler(ResampleSettings settings)
    : settings_(std::move(settings)),
      tracks_(settings_.period_s.size()),
      interval_s_(settings_.period_s[settings_.leader] * static_cast<double>(settings_.samples_per_frame))
{
    assert(tracks_.size() <= max_triads && settings_.leader < tracks_.size() && interval_s_ > 0);
}

void Resampler::add(std::size_t instrument, std::int64_t time_ns, const InstrumentSample& sample)
{
    Track& track = tracks_[instrument];
    if (track.begun && time_ns <= track.last_ns) {
        ++out_of_order_;
        return;
    }
    const double period_s = settings_.period_s[instrument];
    const std::int64_t before_ns = track.begun ? track.last_ns : time_ns - nanoseconds(period_s);
    Span span{time_ns - nanoseconds(period_s), time_ns, sample.rate_rad_s, sample.acceleration_m_s2, sample.clipped.value_or(0)};
    if (sample.covered_s > 0) {
        span.begin_ns = std::max(before_ns, time_ns - nanoseconds(sample.covered_s));
        if (span.begin_ns - before_ns < nanoseconds(bridged * period_s)) span.begin_ns = before_ns;
    } else if (time_ns - before_ns <= nanoseconds(longest_hold * period_s)) {
        span.begin_ns = before_ns;
    }
    track.spans.push_back(span);
    track.last_ns = time_ns;
    track.begun = true;
    if (!first_ns_) first_ns_ = span.begin_ns;
    newest_ns_ = std::max(newest_ns_, time_ns);
    if (instrument == settings_.leader) lead(time_ns);
    else lead_without_leader();
}

/// The leader's sample ends a frame if enough of its samples have passed. The first frame begins with the leader, or with an instrument
/// that began more than a frame before.
void Resampler::lead(std::int64_t time_ns)
{
    if (!last_end_ns_) {
        const std::int64_t own_ns = time_ns - nanoseconds(settings_.period_s[settings_.leader]);
        last_end_ns_ = begin_ns_ = own_ns - *first_ns_ > nanoseconds(interval_s_) ? *first_ns_ : own_ns;
    }
    const double since_s = static_cast<double>(time_ns - *last_end_ns_) * 1e-9;
    const double half_period_s = 0.5 * settings_.period_s[settings_.leader];
    if (since_s < interval_s_ - half_period_s) return;
    push_ends(time_ns, since_s);
}

/// A leader that is far behind the others, or has not begun, gives no ends: they follow at its usual interval.
void Resampler::lead_without_leader()
{
    const std::int64_t latest_ns = newest_ns_ - nanoseconds(settings_.patience_s);
    if (!last_end_ns_ && latest_ns > *first_ns_) last_end_ns_ = begin_ns_ = first_ns_;
    if (!last_end_ns_) return;
    if (latest_ns - *last_end_ns_ < nanoseconds(interval_s_)) return;
    push_ends(latest_ns, static_cast<double>(latest_ns - *last_end_ns_) * 1e-9);
}

void Resampler::finish()
{
    finished_ = true;
    if (!first_ns_) return;
    if (!last_end_ns_) last_end_ns_ = begin_ns_ = first_ns_;
    const double since_s = static_cast<double>(newest_ns_ - *last_end_ns_) * 1e-9;
    if (since_s >= interval_s_) push_ends(newest_ns_, since_s);
}

/// Cuts the time up to an end into intervals of about the usual length.
void Resampler::push_ends(std::int64_t up_to_ns, double since_s)
{
    if (since_s > longest_gap_s) {
        *last_end_ns_ = up_to_ns - nanoseconds(interval_s_);
        ends_ns_.push_back(*last_end_ns_);  // the frame that ends here spans the gap; it is not given out
        since_s = interval_s_;
    }
    const auto count = std::max<std::int64_t>(1, std::llround(since_s / interval_s_));
    const std::int64_t begin_ns = *last_end_ns_;
    for (std::int64_t i = 1; i <= count; ++i)
        ends_ns_.push_back(begin_ns + (up_to_ns - begin_ns) / count * i + (i == count ? (up_to_ns - begin_ns) % count : 0));
    *last_end_ns_ = up_to_ns;
}

bool Resampler::waits_for(const Track& track, std::int64_t end_ns) const
{
    if (finished_) return false;
    const bool behind = !track.begun || track.last_ns < end_ns;
    return behind && newest_ns_ - end_ns < nanoseconds(settings_.patience_s);
}

bool Resampler::next(AlignedFrame& frame)
{
    while (!ends_ns_.empty()) {
        const std::int64_t end_ns = ends_ns_.front();
        for (const Track& track : tracks_)
            if (waits_for(track, end_ns)) return false;
        ends_ns_.pop_front();
        const std::int64_t begin_ns = *begin_ns_;
        *begin_ns_ = end_ns;
        const bool spans_gap = static_cast<double>(end_ns - begin_ns) * 1e-9 > longest_gap_s;
        frame = {};
        frame.time_ns = end_ns;
        frame.interval_s = static_cast<double>(end_ns - begin_ns) * 1e-9;
        frame.count = tracks_.size();
        for (std::size_t i = 0; i < tracks_.size() && !spans_gap; ++i) fill(frame, i, begin_ns);
        for (Track& track : tracks_)
            while (!track.spans.empty() && track.spans.front().end_ns <= end_ns) track.spans.pop_front();
        if (frame.valid_mask == 0) {
            gap_ = true;
            continue;
        }
        frame.after_gap = gap_;
        gap_ = false;
        return true;
    }
    return false;
}

void Resampler::fill(AlignedFrame& frame, std::size_t instrument, std::int64_t begin_ns) const
{
    std::array<double, 3> rate{};
    std::array<double, 3> force{};
    std::array<bool, 3> one_value{true, true, true};
    const Span* first = nullptr;
    std::int64_t covered_ns = 0;
    for (const Span& span : tracks_[instrument].spans) {
        const std::int64_t overlap_ns = std::min(span.end_ns, frame.time_ns) - std::max(span.begin_ns, begin_ns);
        if (span.begin_ns >= frame.time_ns) break;
        if (overlap_ns <= 0) continue;
        if (first == nullptr) first = &span;
        covered_ns += overlap_ns;
        for (std::size_t k = 0; k < 3; ++k) {
            rate[k] += static_cast<double>(overlap_ns) * span.rate_rad_s[k];
            force[k] += static_cast<double>(overlap_ns) * span.acceleration_m_s2[k];
            one_value[k] = one_value[k] && span.rate_rad_s[k] == first->rate_rad_s[k];
            if ((span.clipped >> k & 1U) != 0) frame.clipped_mask |= axis_bit(3 * instrument + k);
        }
    }
    const std::int64_t length_ns = frame.time_ns - begin_ns;
    const auto tolerated_ns = std::max<std::int64_t>(uncovered_rounding_ns, std::llround(uncovered_share * static_cast<double>(length_ns)));
    if (first == nullptr || length_ns - covered_ns > tolerated_ns) return;
    for (std::size_t k = 0; k < 3; ++k) {
        const double mean = one_value[k] ? first->rate_rad_s[k] : rate[k] / static_cast<double>(covered_ns);
        if (std::isfinite(mean)) {
            frame.rate_rad_s[instrument][k] = mean;
            frame.valid_mask |= axis_bit(3 * instrument + k);
        }
        const double mean_force = force[k] / static_cast<double>(covered_ns);
        if (!std::isfinite(mean_force)) continue;
        frame.acceleration_m_s2[instrument][k] = mean_force;
        frame.acceleration_mask |= axis_bit(3 * instrument + k);
    }
}

}  // namespace quorient::recording
