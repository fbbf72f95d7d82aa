#include "quorient/intake/frame_intake.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/restart.hpp"
#include "quorient/messages/sample_time.hpp"
#include "quorient/messages/unit_kind.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::intake {

namespace {

/// A value at the end of its range is legal; rounding must not push it out.
constexpr double range_tolerance = 1.0 + 1e-9;

/// A description may come a little after its first frames; one that stays away so long is missing.
constexpr std::int64_t description_patience_ns = 500'000'000;

/// Sample times count in nanoseconds, and ratios of intervals stay within what a double holds.
constexpr double shortest_interval_s = 1e-9;

/// Longer than any sensor waits; in nanoseconds it is still far from the end of the integers.
constexpr double longest_interval_s = 3600;

bool is_interval(double interval_s)
{
    return interval_s >= shortest_interval_s && interval_s <= longest_interval_s;
}

/// One frame that is not newer is the network's doing; so many without a newer one in between are a publisher that counts again.
constexpr std::uint32_t restart_after = 5;

}  // namespace

const char* FrameIntake::problem_of(const ClusterDescription& description)
{
    const UnitKind& kind = unit_kind(kind_of(description));
    if (description.axis_count < kind.least_axes || description.axis_count > max_axes) return kind.wrong_count;
    if (!is_interval(description.interval_s)) return "its interval must be 1 ns to an hour";
    return nullptr;
}

void FrameIntake::describe(const ClusterDescription& description)
{
    if (description.unit != unit_ || description.kind != octet(kind_)) return;
    if (const char* why = problem_of(description)) {
        ++counters_.rejected_frames;
        complain({.fault = Fault::description, .identity = {description.epoch, 0}, .why = why});
        return;
    }
    for (std::size_t i = 0; i < description_count_; ++i) {
        if (descriptions_[i].epoch == description.epoch && descriptions_[i].revision == description.revision) return;
    }
    descriptions_[description_next_] = description;
    description_next_ = (description_next_ + 1) % remembered_descriptions;
    description_count_ = std::min(description_count_ + 1, remembered_descriptions);
}

bool FrameIntake::offer(const SensorFrame& frame, std::int64_t now_ns)
{
    if (frame.unit != unit_ || frame.kind != octet(kind_)) return false;
    if (!order(frame, now_ns)) return true;
    if (waiting_count_ == waiting_capacity) {
        waiting_begin_ = (waiting_begin_ + 1) % waiting_capacity;
        --waiting_count_;
        ++counters_.waiting_lost;
    }
    waiting_[(waiting_begin_ + waiting_count_) % waiting_capacity] = frame;
    if (++waiting_count_ == 1) waiting_since_ns_ = now_ns;
    look_at_waiting(now_ns);
    return true;
}

void FrameIntake::complain(const Complaint& complaint)
{
    complaint_ = complaint;
    ++complaints_;
}

/// Reports which description the oldest waiting frame has been missing for too long.
void FrameIntake::look_at_waiting(std::int64_t now_ns)
{
    const auto& frame = waiting_[waiting_begin_];
    if (now_ns - waiting_since_ns_ < description_patience_ns || description_for(frame)) return;
    waiting_since_ns_ = now_ns;
    if (complaint_.fault == Fault::description && complaint_.identity.epoch == frame.epoch) return complain(complaint_);
    Complaint missing{.fault = Fault::no_description, .identity = identity_of(frame), .got = frame.description_revision};
    for (std::size_t i = 0; i < description_count_; ++i) {
        if (descriptions_[i].epoch != frame.epoch) continue;
        missing.fault = Fault::unknown_revision;
        missing.expected = std::max<std::uint64_t>(missing.expected, descriptions_[i].revision);
    }
    complain(missing);
}

bool FrameIntake::order(const SensorFrame& frame, std::int64_t now_ns)
{
    const auto identity = identity_of(frame);
    if (started_ && identity.epoch != newest_.epoch) {
        if (identity.epoch < newest_.epoch || static_cast<double>(now_ns - last_arrival_ns_) * 1e-9 < restart_silence_s(interval_s_)) {
            ++counters_.foreign;
            foreign_epoch_ = identity.epoch;
            return false;
        }
        // What still waits for its description is of a publisher that is gone: it must not hold up the new one.
        counters_.waiting_lost += waiting_count_;
        waiting_count_ = 0;
    } else if (started_ && identity <= newest_) {
        ++(identity == newest_ ? counters_.duplicates : counters_.late);
        if (++older_in_a_row_ % restart_after == 0)
            complain({.fault = Fault::sequence_restart, .identity = identity, .got = identity.sequence, .expected = newest_.sequence});
        return false;
    } else if (started_) {
        counters_.gaps += StreamPlace::behind(newest_).missing_before(identity);
    }
    started_ = true;
    older_in_a_row_ = 0;
    newest_ = identity;
    last_arrival_ns_ = now_ns;
    if (is_interval(frame.interval_s)) interval_s_ = frame.interval_s;
    return true;
}

const ClusterDescription* FrameIntake::description_for(const SensorFrame& frame) const
{
    for (std::size_t i = 0; i < description_count_; ++i) {
        if (descriptions_[i].epoch == frame.epoch && descriptions_[i].revision == frame.description_revision) return &descriptions_[i];
    }
    return nullptr;
}

const FrameIntake::Accepted* FrameIntake::next()
{
    while (waiting_count_ > 0) {
        const auto& frame = waiting_[waiting_begin_];
        const auto* description = description_for(frame);
        if (!description) return nullptr;
        accepted_.frame = frame;
        waiting_begin_ = (waiting_begin_ + 1) % waiting_capacity;
        --waiting_count_;
        waiting_since_ns_ = last_arrival_ns_;
        accepted_.new_epoch = frame.epoch != handled_.next().epoch;
        if (!clean(accepted_.frame, *description)) {
            ++counters_.rejected_frames;
            continue;
        }
        accepted_.new_description = !current_ || current_->epoch != description->epoch || current_->revision != description->revision;
        if (accepted_.new_description) current_ = *description;
        accepted_.missing_before = handled_.missing_before(identity_of(frame));
        handled_ = StreamPlace::behind(identity_of(frame));
        last_sample_time_ns_ = accepted_.frame.sample_time_ns;
        ++counters_.accepted;
        return &accepted_;
    }
    return nullptr;
}

bool FrameIntake::clean(SensorFrame& frame, const ClusterDescription& description)
{
    Complaint wrong{.identity = identity_of(frame)};
    if (frame.axis_count != description.axis_count)
        wrong = {.fault = Fault::axis_count, .identity = wrong.identity, .got = frame.axis_count, .expected = description.axis_count};
    else if (!is_interval(frame.interval_s)) wrong.fault = Fault::interval;
    else if (!is_sample_time(frame.sample_time_ns)) wrong.fault = Fault::sample_time;
    else if (!accepted_.new_epoch && frame.sample_time_ns <= last_sample_time_ns_) wrong.fault = Fault::sample_time;
    if (wrong.fault != Fault::none) {
        complain(wrong);
        return false;
    }
    for (std::size_t axis = 0; axis < frame.axis_count; ++axis) {
        if (!has_axis(frame.valid_mask, axis)) continue;
        const double limit = description.range[axis] * frame.interval_s * range_tolerance + description.quantum[axis];
        const bool in_range = description.range[axis] == 0 || std::abs(frame.increment[axis]) <= limit;
        if (std::isfinite(frame.increment[axis]) && std::isfinite(frame.accumulated[axis]) && in_range) continue;
        frame.valid_mask &= ~axis_bit(axis);
        ++counters_.rejected_values;
        complain({.fault = Fault::value, .identity = wrong.identity, .got = axis});
    }
    frame.valid_mask &= all_axes(frame.axis_count);
    return true;
}

}  // namespace quorient::intake
