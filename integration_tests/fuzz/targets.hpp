#pragma once

#include <cstddef>
#include <cstdint>

namespace quorient::fuzz {

// Each takes bytes from whoever, does what a process would do with them, and aborts where a promise of its brain is broken.

/// Descriptions and frames, good and spoiled: intake, detector, integrator.
void frames(const std::uint8_t* data, std::size_t size);

/// Attitudes, verdicts and another voter's output, good and spoiled: the voter.
void votes(const std::uint8_t* data, std::size_t size);

/// sensor_msgs/Imu of four IMUs: their alignment.
void imus(const std::uint8_t* data, std::size_t size);

/// CDR of every type, ROS 2's too, by Fast DDS's generated code, and ours out of theirs.
void decode(const std::uint8_t* data, std::size_t size);

}  // namespace quorient::fuzz
