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

/// Logs: each reader by itself, and whatever the door takes them for, compressed or not.
void dataflash(const std::uint8_t* data, std::size_t size);
void ulog(const std::uint8_t* data, std::size_t size);
void csv(const std::uint8_t* data, std::size_t size);
void mcap(const std::uint8_t* data, std::size_t size);
void sqlite(const std::uint8_t* data, std::size_t size);
void logs(const std::uint8_t* data, std::size_t size);

/// Samples of several instruments with times of any kind: their clocks and the common intervals.
void times(const std::uint8_t* data, std::size_t size);

}  // namespace quorient::fuzz
