#pragma once

#include "quorient/messages/identity.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace quorient::voting {

/// Frames that are remembered; also the farthest that a lane may run ahead of the others, times two. After an absence a voter finds 64
/// frames in its readers' queues and listens for a lease (50 frames at 1 kHz): all of them are published late, if nobody else has.
inline constexpr std::uint64_t frame_window = 128;

/// Outputs that one call may make: all frames that are remembered, and repetitions.
inline constexpr std::size_t longest_burst = 192;

/// Which frames exist, which are published, and when each one is due.
///
/// A frame is due when its first sample arrives, but not before the previous ones let expect it: a lane that runs ahead of time
/// cannot use up the patience that the others are owed.
class Timeline {
public:
    enum class Arrival {
        fresh,  ///< its frame is still to be published
        late,   ///< its frame was passed a short while ago
        old,    ///< before everything remembered
        ahead,  ///< its epoch or sequence is not to be expected now
    };

    explicit Timeline(std::int64_t interval_ns) : interval_ns_(interval_ns) {}

    bool started() const { return epoch_.has_value(); }

    /// Everything known is forgotten; `first` is the next frame to be published.
    void start(Identity first, std::int64_t now_ns);

    Arrival classify(Identity identity, std::int64_t now_ns) const;

    /// A fresh sample came. Frames too old to be remembered beside it are passed.
    void open(Identity identity, std::int64_t now_ns);

    /// The frame is published at now_ns; what lies before it and was not, never will be.
    /// @param on_votes  enough votes came (as opposed to: patience ended): now_ns shows when the next frames may be expected.
    void publish(std::uint64_t sequence, bool on_votes, std::int64_t now_ns);

    /// No frame is remembered, none is waited for; what may still be published stays.
    void forget_frames() { frame_.fill({}); }

    /// Frames up to this one will not be published.
    void pass(Identity identity);

    /// The first frame from `sequence` on of which a sample arrived.
    std::optional<std::uint64_t> next_open(std::uint64_t sequence) const;

    std::uint64_t epoch() const { return epoch_.value_or(0); }
    std::uint64_t next() const { return next_; }  ///< lowest sequence that may still be published
    Identity newest() const { return {epoch(), newest_}; }
    Identity identity(std::uint64_t sequence) const { return {epoch(), sequence}; }
    std::int64_t due_ns(std::uint64_t sequence) const { return frame_[sequence % frame_window].due_ns; }

private:
    struct Frame {
        std::uint64_t sequence = 0;
        std::int64_t due_ns = 0;
        bool open = false;
    };

    std::uint64_t oldest() const { return newest_ >= frame_window ? newest_ - frame_window + 1 : 0; }

    std::array<Frame, frame_window> frame_{};
    std::optional<std::uint64_t> epoch_;
    std::uint64_t next_ = 0;
    std::uint64_t newest_ = 0;
    std::uint64_t anchor_sequence_ = 0;  ///< a published frame …
    std::int64_t anchor_ns_ = 0;         ///< … and when it was due
    std::int64_t interval_ns_;
};

}  // namespace quorient::voting
