#pragma once

#include "quorient/messages/codes.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace quorient {

/// What follows from the kind of quantity that a unit measures. Code that treats kinds differently asks this object; a further kind is a
/// further entry of `unit_kinds`. Its word is to_string(code).
struct UnitKind {
    SensorKind code = SensorKind::unknown;
    std::string_view subject;      ///< what gives the measurements, in sentences
    std::string_view axes;         ///< what its measurements are called
    bool gives_attitude = false;   ///< has integrators and voters
    bool has_model = false;        ///< its detectors are observers of a plant: axes are no directions in space
    std::size_t least_axes = 3;    ///< in a description …
    const char* wrong_count = "";  ///< … and what is said of one with less, or more than max_axes
    std::uint64_t frame_end = 1;   ///< intervals from the time of a frame's number to that of its measurement's end
};

inline constexpr std::array<UnitKind, 3> unit_kinds{{
    {SensorKind::gyro, "gyros", "axes", true, false, 3, "it must have 3 to 24 axes", 1},
    {SensorKind::accelerometer, "accelerometers", "axes", false, false, 3, "it must have 3 to 24 axes", 1},
    {SensorKind::vessel_rates, "a vessel's rates", "channels", false, true, 1, "it must have 1 to 24 channels", 0},
}};

/// @param code  from this process or from the wire; an unknown one is taken for gyros
constexpr const UnitKind& unit_kind(SensorKind code)
{
    for (const UnitKind& kind : unit_kinds)
        if (kind.code == code) return kind;
    return unit_kinds.front();
}

}  // namespace quorient
