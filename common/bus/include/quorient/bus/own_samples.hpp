#pragma once

#include "quorient/bus/topics.hpp"

#include <cstdint>

namespace quorient::bus {

/// What the readers of a vendor's bus do with samples of writers of the same bus.
enum class OwnSamples : std::uint8_t {
    received,  ///< as any others
    skipped,   ///< they come another way (composed_bus.hpp); matched counts leave these writers and readers out
};

/// Whether a composed bus hands samples of this topic over itself. An exclusive topic stays with the vendor, which decides on the owner;
/// so do ROS 2's types, which the vendors' folders convert.
constexpr bool is_handed_over(const TopicSpec& topic)
{
    return !topic.qos.exclusive && static_cast<std::size_t>(topic.type) < type_count;
}

/// Whether readers of this topic skip what their own bus writes.
constexpr bool skips_own(OwnSamples own, const TopicSpec& topic)
{
    return own == OwnSamples::skipped && is_handed_over(topic);
}

}  // namespace quorient::bus
