#pragma once

#include "quorient/messages/limits.hpp"
#include "quorient/messages/name.hpp"

#include <array>
#include <cstdint>

namespace quorient {

/// Where a unit's sensors point and how good they are. Latched: every consumer learns the geometry from it.
struct ClusterDescription {
    std::uint64_t epoch = 0;
    double interval_s = 0;                                     ///< nominal interval between frames
    std::array<std::array<double, 3>, max_axes> axis{};        ///< unit vectors in the body frame
    std::array<std::array<double, 3>, max_axes> position_m{};  ///< in the body frame
    std::array<double, max_axes> sigma{};                      ///< one increment's, noise alone [rad; m/s]
    std::array<double, max_axes> quantum{};                    ///< [rad; m/s], 0 = none
    std::array<double, max_axes> range{};                      ///< largest rate [rad/s; m/s^2], 0 = none stated
    std::array<double, max_axes> bias{};                       ///< already taken out by the publisher [rad/s; m/s^2]
    std::array<double, 4> initial_attitude{1, 0, 0, 0};        ///< body -> reference at the start of sequence 0 (w,x,y,z)
    std::uint32_t unit = 0;
    std::uint32_t revision = 0;
    std::array<std::uint8_t, max_axes> instrument{};  ///< each axis's
    std::array<Name<16>, max_axes> instrument_name{};
    Name<32> name{};
    std::uint8_t kind = 0;  ///< SensorKind
    std::uint8_t axis_count = 0;
    std::uint8_t instrument_count = 0;
    std::uint8_t initial_attitude_known = 0;  ///< InitialAttitude
    std::array<std::uint8_t, 4> padding{};
};

}  // namespace quorient
