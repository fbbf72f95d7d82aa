#pragma once

#include "bytes/byte_source.hpp"
#include "quorient/recording/instrument_log.hpp"

#include <optional>

namespace quorient::recording::ros {

/// What of a sensor_msgs/Imu matters here.
struct ImuMessage {
    std::int64_t stamp_ns = 0;
    std::array<double, 3> angular_velocity_rad_s{};
    std::array<double, 3> linear_acceleration_m_s2{};
    bool has_rate = true;          ///< a covariance of -1 says that there is none
    bool has_acceleration = true;
};

/// A message as ROS 2 stores it: 4 bytes that name the encapsulation, then CDR of either byte order (XCDR1, or plain XCDR2).
std::optional<ImuMessage> parse_cdr_imu(Bytes message);

/// The same, which rosbag2 may have compressed by itself (zstd).
std::optional<ImuMessage> parse_stored_imu(Bytes message);

/// A message as ROS 1 stores it: little-endian, without padding.
std::optional<ImuMessage> parse_ros1_imu(Bytes message);

Instrument instrument_of(const std::string& topic);

/// @param stored_ns  time of storing, where the message has no stamp
/// @returns nothing if the message has no rates
std::optional<InstrumentSample> sample_of(const ImuMessage& message, std::int64_t stored_ns);

}  // namespace quorient::recording::ros
