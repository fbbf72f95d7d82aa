#pragma once

#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/limits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace quorient::voting {

/// Samples of frames that were not expected: another epoch, or a sequence far ahead. They wait here until it is clear whether
/// the publisher moved on (a majority of lanes says so, or no other lane says otherwise for the grace time) or one lane strays.
class Newcomers {
public:
    Newcomers(std::size_t lanes, std::size_t majority, std::int64_t grace_ns) : lanes_(lanes), majority_(majority), grace_ns_(grace_ns) {}

    void hold(std::size_t lane, const AttitudeState& sample, std::int64_t now_ns);

    /// A lane delivered what was expected; `counts` unless it is excluded.
    void expected(std::size_t lane, bool counts, std::int64_t now_ns);

    /// The frame at which a new timeline starts.
    std::optional<Identity> accepted(std::int64_t now_ns) const;

    /// The first frame that a lane of this timeline delivered. It was not kept where later ones came before the timeline was accepted.
    Identity begin(Identity start) const;

    /// The lane's held sample, taken out; nothing where it is of another timeline than `start`.
    std::optional<AttitudeState> take(std::size_t lane, Identity start);

    /// When `accepted` may change its mind without a new sample.
    std::int64_t deadline_ns() const;

private:
    struct Held {
        AttitudeState sample;
        Identity first;  ///< The earliest sample of this timeline.
        std::int64_t since_ns = 0;
        bool present = false;
    };

    static bool same_timeline(const Identity& a, const Identity& b);

    std::array<Held, max_lanes> held_{};
    std::size_t lanes_;
    std::size_t majority_;
    std::int64_t grace_ns_;
    std::optional<std::int64_t> expected_ns_;  ///< when a lane last delivered what was expected
};

}  // namespace quorient::voting
