#pragma once

#include "quorient/messages/identity.hpp"

#include <cstdint>

namespace quorient {

/// Where a consumer stands in a stream of frames, and so which frames are missing before the next one it gets.
///
/// Each consumer has its own place. What the network lost is missing to all of them; what the intake refused, or what a method could not use,
/// is missing to those behind it alone.
class StreamPlace {
public:
    /// Behind this frame, received here or not.
    static constexpr StreamPlace behind(Identity frame) { return StreamPlace({frame.epoch, frame.sequence + 1}); }

    static constexpr StreamPlace at_begin_of(std::uint64_t epoch) { return StreamPlace({epoch, 0}); }

    /// Nowhere yet: before the first frame of epoch 0, which no publisher has.
    StreamPlace() = default;

    /// The frame that follows without a gap.
    Identity next() const { return next_; }

    bool follows(Identity frame) const { return frame == next_; }

    /// Frames missing before this one, which is not older than next(). In another epoch sequences count from 0.
    std::uint64_t missing_before(Identity frame) const { return frame.sequence - (frame.epoch == next_.epoch ? next_.sequence : 0); }

private:
    explicit constexpr StreamPlace(Identity next) : next_(next) {}

    Identity next_;
};

}  // namespace quorient
