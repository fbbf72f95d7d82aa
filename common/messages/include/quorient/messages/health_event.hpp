#pragma once

#include "quorient/messages/cluster_description.hpp"

#include <array>
#include <cstdint>

namespace quorient {

/// Something an operator may want to know, once.
struct HealthEvent {
    std::uint64_t epoch = 0;
    std::uint64_t sequence = 0;
    std::int64_t wall_time_ns = 0;   ///< since 1970, of the source's host
    std::uint64_t event_number = 0;  ///< counts the source's events from 1
    std::uint64_t request = 0;       ///< the FaultCommand that it answers, 0 = none
    std::uint32_t unit = 0;
    std::uint32_t source = 0;   ///< service id
    std::uint32_t axes = 0;     ///< AxisMask that the event is about
    std::uint8_t code = 0;      ///< EventCode
    std::uint8_t severity = 0;  ///< Severity
    std::array<std::uint8_t, 2> padding{};
    Name<32> source_name{};
    Name<160> text{};
};

}  // namespace quorient
