#pragma once

#include "quorient/bus/topics.hpp"

namespace quorient::bus::ros2 {

/// sensor_msgs/Imu. Strings and sequences have bounds here; longer ones of a foreign node are cut.
struct Imu {
    std::int64_t stamp_ns = 0;  ///< since 1970
    Name<64> frame_id{};
    std::array<double, 4> orientation{1, 0, 0, 0};    ///< body -> world, (w,x,y,z) here, (x,y,z,w) on the wire
    std::array<double, 9> orientation_covariance{};   ///< [rad^2], row by row; first element -1: no orientation
    std::array<double, 3> rate_rad_s{};               ///< body frame
    std::array<double, 9> rate_covariance{};          ///< [rad^2/s^2]; all 0: not known
    std::array<double, 3> acceleration_m_s2{};        ///< body frame, specific force
    std::array<double, 9> acceleration_covariance{};  ///< [m^2/s^4]
};

/// The levels of diagnostic_msgs/DiagnosticStatus.
enum class Level : std::uint8_t { ok = 0, warning = 1, error = 2, stale = 3 };

struct KeyValue {
    Name<32> key{};
    Name<64> value{};
};

struct DiagnosticStatus {
    std::uint8_t level = 0;  ///< Level
    Name<64> name{};
    Name<128> message{};
    Name<64> hardware_id{};
    std::uint32_t value_count = 0;
    std::array<KeyValue, 6> values{};
};

inline constexpr std::size_t max_diagnostics = 48;

/// diagnostic_msgs/DiagnosticArray.
struct DiagnosticArray {
    std::int64_t stamp_ns = 0;  ///< since 1970
    std::uint32_t count = 0;
    std::array<DiagnosticStatus, max_diagnostics> status{};
};

/// For writers: RELIABLE matches readers of ROS 2's sensor-data profile (BEST_EFFORT) and of its default profile (RELIABLE).
inline constexpr Qos offered{.reliable = true, .depth = 10};

/// For readers: BEST_EFFORT matches writers of either profile.
inline constexpr Qos requested{.reliable = false, .depth = 64};

/// @param name  DDS name with ROS 2's prefix: "rt/imu/data". Must outlive the topic.
constexpr Topic<Imu> imu(const char* name, const Qos& qos)
{
    return {name, TypeId::ros2_imu, qos};
}
constexpr Topic<DiagnosticArray> diagnostics(const char* name, const Qos& qos)
{
    return {name, TypeId::ros2_diagnostics, qos};
}

}  // namespace quorient::bus::ros2
