#pragma once

#include "tick.hpp"

#include <cstdint>
#include <string_view>

namespace quorient::monitor {

/// What the page shows of one axis, from harmless to grave.
enum class AxisState : std::uint8_t {
    unknown,    ///< nobody reports it now
    healthy,
    degraded,   ///< noisy or late, still in use
    suspect,    ///< a fault is seen and not yet confirmed
    saturated,  ///< at its range
    absent,     ///< sends no data
    left_out,   ///< provisionally, until the contradiction ends or is confirmed
    isolated,   ///< a confirmed fault
};

std::string_view to_string(AxisState state);

/// What one detector reports of an axis.
AxisState state_in_lane(const LaneTick& lane, std::size_t axis);

/// What the system makes of an axis: the voted attitude decides which axes are isolated, left out or suspect; the rest is the gravest
/// that a detector reports. Without a fresh voted attitude the detectors alone decide.
AxisState state_in_system(const Tick& tick, std::size_t lanes, std::size_t axis);

}  // namespace quorient::monitor
