#include "frame_stream.hpp"

#include <cmath>

namespace quorient::attitude {
namespace {

// Beyond this it is no rotation of one interval, and its square would leave the range of a double.
constexpr double largest_increment = 1e6;

void set_increment(Record& record, std::size_t axis, double increment)
{
    if (!(std::abs(increment) <= largest_increment)) return;
    record.increment[axis] = increment;
    record.valid |= axis_bit(axis);
}

}  // namespace

void FrameStream::begin_epoch(std::uint64_t epoch)
{
    knowledge_ = Knowledge::angles;
    place_ = StreamPlace::at_begin_of(epoch);
    accumulated_.fill(0);
    missed_.fill(0);
}

void FrameStream::go_on_after(Identity identity)
{
    knowledge_ = Knowledge::place;
    place_ = StreamPlace::behind(identity);
}

void FrameStream::write_gap(const SensorFrame& frame, Record& record) const
{
    const std::uint64_t lost = lost_before(frame);
    record.first_sequence = next_sequence();
    record.last_sequence = frame.sequence - 1;
    record.interval_s = static_cast<double>(lost) * frame.interval_s;
    record.bridge = true;
    if (knowledge_ != Knowledge::angles) return;
    for (std::size_t axis = 0; axis < axis_count_; ++axis) {
        const bool own = has_axis(frame.valid_mask, axis);
        const bool complete = frame.missed[axis] - missed_[axis] == (own ? 0U : 1U);
        if (complete) set_increment(record, axis, frame.accumulated[axis] - accumulated_[axis] - (own ? frame.increment[axis] : 0));
    }
}

void FrameStream::write_frame(const SensorFrame& frame, Record& record) const
{
    record.first_sequence = record.last_sequence = frame.sequence;
    record.interval_s = frame.interval_s;
    for (std::size_t axis = 0; axis < axis_count_; ++axis)
        if (has_axis(frame.valid_mask, axis)) set_increment(record, axis, frame.increment[axis]);
}

void FrameStream::take(const SensorFrame& frame)
{
    bridged_ = lost_before(frame) > 0;
    knowledge_ = Knowledge::angles;
    place_ = StreamPlace::behind(identity_of(frame));
    sample_time_ns_ = frame.sample_time_ns;
    accumulated_ = frame.accumulated;
    missed_ = frame.missed;
}

}  // namespace quorient::attitude
