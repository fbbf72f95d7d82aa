#include "quorient/runtime/overload.hpp"

#include "quorient/messages/time.hpp"
#include "quorient/runtime/pace.hpp"

#include <algorithm>

namespace quorient::runtime {

namespace {

constexpr double old_intervals = 10;
constexpr double old_at_least_s = 0.01;

/// Kept frames must come at least twice in a lease of `voted`, which is 50 ms or more.
constexpr double longest_kept_interval_s = 0.025;

/// Samples that are old for more than a seventeenth of the time add up.
constexpr std::int64_t forgiveness = 16;

/// In a trial so little is enough to show that the overload goes on.
constexpr std::int64_t relapse_ns = 10'000'000;

/// In a trial the others begin at the same stamp, but their samples are on the way.
constexpr std::int64_t grace_ns = 1'000'000'000;

/// A service that begins to shed still has a queue to work off.
constexpr std::int64_t shed_at_least_ns = 1'000'000'000;

}  // namespace

std::int64_t SampleAge::see(std::uint64_t epoch, std::int64_t stamp_ns, std::int64_t now_ns)
{
    if (stamp_ns <= 0) return 0;
    const std::int64_t way_ns = now_ns - stamp_ns;
    if (!begun_ || epoch != epoch_) {
        begun_ = true;
        epoch_ = epoch;
        window_begin_ns_ = now_ns;
        least_ns_ = least_before_ns_ = way_ns;
    } else if (now_ns - window_begin_ns_ > window_ns) {
        window_begin_ns_ = now_ns;
        least_before_ns_ = least_ns_;
        least_ns_ = way_ns;
    }
    least_ns_ = std::min(least_ns_, way_ns);
    return way_ns - std::min(least_ns_, least_before_ns_);
}

Overload::Overload(double interval_s)
    : bound_ns_(nanoseconds(std::max(old_intervals * interval_s, old_at_least_s))),
      may_shed_(Pace::kept_of * interval_s <= longest_kept_interval_s)
{
}

void Overload::measure(bool old, std::int64_t now_ns)
{
    const std::int64_t span_ns = std::max<std::int64_t>(0, now_ns - last_ns_);
    // Before the first old sample the consumer stood still, or nothing came: that is no overload.
    // So a gap behind an old sample counts as one such sample.
    if (old && old_) behind_ns_ = std::min(behind_ns_ + std::min(span_ns, bound_ns_), state_ == State::falling_behind ? lasting_ns : 2 * relapse_ns);
    if (!old) behind_ns_ = std::max<std::int64_t>(0, behind_ns_ - span_ns / forgiveness);
    old_ = old;
    last_ns_ = now_ns;
}

void Overload::enter(State state, std::int64_t now_ns)
{
    state_ = state;
    since_ns_ = now_ns;
    if (state != State::falling_behind) behind_ns_ = 0;
}

void Overload::fail(std::int64_t now_ns)
{
    period_ns_ = std::min(rarer * period_ns_, longest_period_ns);
    enter(State::shedding, now_ns);
}

Overload::State Overload::on_others_shed(std::int64_t now_ns)
{
    if (!may_shed_) return state_;
    if (state_ == State::trying && now_ns - since_ns_ >= grace_ns) fail(now_ns);
    else if (state_ == State::keeping_up || state_ == State::falling_behind) enter(State::shedding, now_ns);
    return state_;
}

Overload::State Overload::on_sample(std::int64_t age_ns, std::int64_t stamp_ns, std::int64_t now_ns)
{
    if (!may_shed_) return state_;
    const bool old = age_ns > bound_ns_;
    const bool passes_period = stamp_ns / period_ns_ != last_stamp_ns_ / period_ns_;
    last_stamp_ns_ = stamp_ns;
    measure(old, now_ns);
    switch (state_) {
        case State::keeping_up:
            if (old) enter(State::falling_behind, now_ns);
            break;
        case State::falling_behind:
            if (behind_ns_ >= lasting_ns) enter(State::shedding, now_ns);
            else if (!old && behind_ns_ == 0) enter(State::keeping_up, now_ns);
            break;
        case State::shedding:
            if (passes_period && behind_ns_ < relapse_ns && now_ns - since_ns_ >= shed_at_least_ns) enter(State::trying, now_ns);
            break;
        case State::trying:
            if (behind_ns_ >= relapse_ns) fail(now_ns);
            else if (now_ns - since_ns_ >= trial_ns) {
                period_ns_ = first_period_ns;
                enter(State::keeping_up, now_ns);
            }
            break;
    }
    return state_;
}

}  // namespace quorient::runtime
