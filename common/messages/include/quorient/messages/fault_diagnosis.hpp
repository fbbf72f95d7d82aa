#pragma once

#include "quorient/messages/limits.hpp"

#include <array>
#include <cstdint>

namespace quorient {

/// What a detector knows of each axis that it blames: what is wrong, and by how much. Sent when it changes and once a second, since
/// the figures become more exact while the fault lasts. Latched: the newest one is complete.
struct FaultDiagnosis {
    std::uint64_t epoch = 0;  ///< identity of the newest frame that it rests on
    std::uint64_t sequence = 0;
    std::int64_t sample_time_ns = 0;
    std::array<double, max_axes> size{};        ///< in the unit of the diagnosis (codes.hpp); 0 where there is none
    std::array<double, max_axes> sigma{};       ///< standard deviation of the size
    std::array<double, max_axes> bias{};        ///< a diagnosed axis's, whatever its diagnosis [rad/s; m/s^2]
    std::array<double, max_axes> bias_sigma{};  ///< standard deviation of the bias
    std::uint32_t unit = 0;
    std::uint32_t detector = 0;
    std::uint32_t provisional_mask = 0;  ///< left out until the contradiction ends or is confirmed
    std::uint32_t absent_mask = 0;       ///< without data now
    std::uint32_t degraded_mask = 0;     ///< noisy or late, still in use
    std::array<std::uint8_t, max_axes> diagnosis{};  ///< Diagnosis
    std::uint8_t kind = 0;                           ///< SensorKind
    std::array<std::uint8_t, 3> padding{};
};

}  // namespace quorient
