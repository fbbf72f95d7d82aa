#pragma once

#include "history.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/stream_place.hpp"

#include <array>

namespace quorient::attitude {

/// Which frames have come, and the angles accumulated up to the newest one: from these a gap is bridged.
class FrameStream {
public:
    /// What is known of the frame before the next one.
    enum class Knowledge {
        nothing,  ///< no frame has come, and none was named
        place,    ///< its identity, from a seed: what turns before the next frame cannot be known unless that one follows directly
        angles,   ///< its identity and its accumulated angles (all 0 before the first frame of an epoch)
    };

    explicit FrameStream(std::size_t axis_count) : axis_count_(axis_count) {}

    Knowledge knowledge() const { return knowledge_; }
    bool has_epoch() const { return knowledge_ != Knowledge::nothing; }
    bool is_epoch(std::uint64_t epoch) const { return has_epoch() && epoch == this->epoch(); }
    std::uint64_t epoch() const { return place_.next().epoch; }
    std::uint64_t next_sequence() const { return place_.next().sequence; }
    std::int64_t sample_time_ns() const { return sample_time_ns_; }

    /// Frames are missing before the newest one.
    bool is_bridged() const { return bridged_; }

    /// Older than one that came before, or the same.
    bool has_passed(Identity identity) const { return has_epoch() && identity < place_.next(); }

    /// An epoch before this one.
    bool has_passed_epoch(std::uint64_t epoch) const { return has_epoch() && epoch < this->epoch(); }

    void begin_epoch(std::uint64_t epoch);

    /// The next frame is the one after this, which was not received here.
    void go_on_after(Identity identity);

    /// Frames that never arrived before this one, of the same epoch.
    std::uint64_t lost_before(const SensorFrame& frame) const { return place_.missing_before(identity_of(frame)); }

    /// The frames that are missing before this one, as one interval. Only axes that missed nothing in it are valid.
    void write_gap(const SensorFrame& frame, Record& record) const;

    /// The frame itself. Increments that are not finite, or beyond any rotation of one interval, are not valid.
    void write_frame(const SensorFrame& frame, Record& record) const;

    /// This frame is now the newest.
    void take(const SensorFrame& frame);

private:
    std::size_t axis_count_;
    Knowledge knowledge_ = Knowledge::nothing;
    StreamPlace place_;
    std::int64_t sample_time_ns_ = 0;             // the newest frame's
    bool bridged_ = false;                        // likewise
    std::array<double, max_axes> accumulated_{};  // up to the frame before next_sequence(), where its angles are known
    std::array<std::uint32_t, max_axes> missed_{};
};

}  // namespace quorient::attitude
