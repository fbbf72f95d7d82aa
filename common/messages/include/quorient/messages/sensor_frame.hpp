#pragma once

#include "quorient/messages/limits.hpp"
#include "quorient/messages/stamps.hpp"

#include <array>
#include <cstdint>

namespace quorient {

/// What all axes of a cluster measured over one interval that ends at sample_time_ns.
struct SensorFrame {
    std::uint64_t epoch = 0;
    std::uint64_t sequence = 0;
    std::int64_t sample_time_ns = 0;  ///< by the instrument's own clock, strictly increasing within an epoch
    double interval_s = 0;
    std::array<double, max_axes> increment{};    ///< quasi-coordinates: the integral of the rate over the interval [rad; m/s]
    std::array<double, max_axes> accumulated{};  ///< sum of the valid increments since sequence 0 [rad; m/s]
    std::array<double, 4> known_input{};         ///< e.g. the rudder angle [rad]
    Stamps stamp_ns{};
    std::array<std::uint32_t, max_axes> missed{};  ///< how many increments of this axis were not valid
    std::uint32_t unit = 0;
    std::uint32_t valid_mask = 0;
    std::uint32_t description_revision = 0;
    std::uint8_t kind = 0;  ///< SensorKind
    std::uint8_t axis_count = 0;
    std::array<std::uint8_t, 2> padding{};
};

}  // namespace quorient
