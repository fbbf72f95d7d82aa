#pragma once

#include "quorient/settings/bounds.hpp"

#include <cstdint>

namespace quorient::system {

/// Numbers that a unit may have.
inline constexpr settings::Bounds unit_ids{.lowest = 0, .highest = 65'535};

// Service ids are unique in a domain: 100 to a unit. Lanes and voters are numbered from 1.
inline constexpr std::uint32_t services_per_unit = 100;
inline constexpr std::uint32_t sensor_service = 1;
inline constexpr std::uint32_t first_detector_service = 10;
inline constexpr std::uint32_t first_integrator_service = 20;
inline constexpr std::uint32_t first_voter_service = 30;
inline constexpr std::uint32_t monitor_service = 90;
inline constexpr std::uint32_t web_monitor_service = 91;

}  // namespace quorient::system
