#pragma once

#include <array>
#include <cstdint>

namespace quorient {

/// What the simulator knows and no sensor measures. Read by monitors and tests, never by the pipeline.
struct TruthState {
    std::uint64_t epoch = 0;
    std::uint64_t sequence = 0;
    std::int64_t sample_time_ns = 0;
    std::array<double, 4> attitude{1, 0, 0, 0};  ///< q_RB at the end of the frame (w,x,y,z)
    std::array<double, 3> rate_rad_s{};
    std::uint32_t unit = 0;
    std::uint32_t faulty_mask = 0;  ///< axes that a fault really touches in this frame
    std::uint8_t attitude_known = 0;
    std::array<std::uint8_t, 7> padding{};
};

}  // namespace quorient
