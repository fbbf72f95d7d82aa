#pragma once

#include "scene.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

namespace quorient::voting::test {

/// Every lane but this one sends its sample.
inline auto all_but(std::size_t absent)
{
    return [absent](std::size_t lane, AttitudeState&) { return lane != absent; };
}

/// No lane but this one sends its sample.
inline auto only(std::size_t present)
{
    return [present](std::size_t lane, AttitudeState&) { return lane == present; };
}

/// Coasting aside.
inline void expect_every_frame_once(const Scene& scene, std::uint64_t first, std::uint64_t last)
{
    std::uint64_t expected = first;
    for (const VotedAttitude& output : scene.outputs) {
        if (mode_of(output) == AttitudeMode::coasting) continue;
        EXPECT_EQ(output.sequence, expected);
        expected = output.sequence + 1;
    }
    EXPECT_EQ(expected, last + 1);
}

}  // namespace quorient::voting::test
