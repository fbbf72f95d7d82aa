#pragma once

#include "quorient/messages/cluster_description.hpp"

#include <array>
#include <cstdint>

namespace quorient {

/// How a service is doing, twice a second and at every change of state.
struct ServiceStatus {
    std::int64_t wall_time_ns = 0;
    std::uint64_t epoch = 0;  ///< identity of the newest frame, verdict or attitude handled
    std::uint64_t sequence = 0;
    std::uint64_t received = 0;
    std::uint64_t published = 0;
    std::uint64_t gaps = 0;  ///< frames that never arrived
    std::uint64_t duplicates = 0;
    std::uint64_t late = 0;
    std::uint64_t foreign = 0;          ///< samples of a second publisher of the same unit
    std::uint64_t rejected = 0;         ///< axes and frames refused before they reached the mathematics
    std::array<double, 4> latency_s{};  ///< from arrival to publication: p50, p90, p99, max since the last status
    std::uint32_t unit = 0;
    std::uint32_t service = 0;  ///< service id
    std::uint32_t matched = 0;  ///< peers of the service's main input
    std::uint32_t process = 0;
    std::uint8_t role = 0;       ///< ServiceRole
    std::uint8_t state = 0;      ///< ServiceState
    std::uint8_t vendor = 0;     ///< Vendor
    std::uint8_t transport = 0;  ///< Transport really in use on the main output
    std::array<std::uint8_t, 4> padding{};
    Name<32> name{};
    Name<16> version{};
};

}  // namespace quorient
