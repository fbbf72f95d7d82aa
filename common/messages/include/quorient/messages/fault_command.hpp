#pragma once

#include <array>
#include <cstdint>

namespace quorient {

/// An order to a unit's services. Each that it concerns answers with one HealthEvent that carries the request.
struct FaultCommand {
    std::uint64_t request = 0;
    double value = 0;    ///< unit by kind of fault; for reset_attitude: the sequence at whose end the attitude holds
    double start_s = 0;  ///< from now
    double end_s = 0;    ///< from now; infinite = until cleared
    double frequency_hz = 0;
    double period_s = 0;
    std::array<double, 4> attitude{1, 0, 0, 0};  ///< for reset_attitude
    std::uint32_t unit = 0;
    std::uint32_t axes = 0;   ///< AxisMask
    std::uint8_t action = 0;  ///< CommandAction
    std::uint8_t kind = 0;    ///< FaultKind
    std::array<std::uint8_t, 6> padding{};
};

}  // namespace quorient
