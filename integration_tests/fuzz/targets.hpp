#pragma once

#include <cstddef>
#include <cstdint>

namespace quorient::fuzz {

// Each target takes arbitrary bytes, handles them as a process would, and aborts if a guarantee of the process is broken.

/// Descriptions and frames, good and spoiled: intake, detector, integrator.
void frames(const std::uint8_t* data, std::size_t size);

/// Attitudes, verdicts and another voter's output, good and spoiled: the voter.
void votes(const std::uint8_t* data, std::size_t size);

/// sensor_msgs/Imu of four IMUs: their alignment.
void imus(const std::uint8_t* data, std::size_t size);

/// Decodes CDR of every type, ROS 2's too, by Fast DDS's generated code, then converts to our messages.
void decode(const std::uint8_t* data, std::size_t size);

}  // namespace quorient::fuzz
