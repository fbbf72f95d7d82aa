#pragma once

#include "bytes.hpp"

namespace quorient::recording::test {

/// Writes ULog files as PX4 does.
class UlogWriter {
public:
    UlogWriter() { log.put(std::array<std::uint8_t, 7>{'U', 'L', 'o', 'g', 0x01, 0x12, 0x35}).put(std::uint8_t{1}).put(std::uint64_t{0}); }

    void message(char type, const Bytes& content)
    {
        log.put(static_cast<std::uint16_t>(content.data.size())).put(type);
        log.data.insert(log.data.end(), content.data.begin(), content.data.end());
    }

    /// Must be the first message. @param incompatible  the first byte of these flags
    void flags(std::uint8_t incompatible, std::uint64_t appended_at)
    {
        Bytes content;
        content.put(std::array<std::uint8_t, 8>{}).put(std::array<std::uint8_t, 8>{incompatible});
        content.put(std::array<std::uint64_t, 3>{appended_at});
        message('B', content);
    }

    void format(const std::string& text) { message('F', Bytes().put(text)); }

    void subscribe(std::uint16_t id, std::uint8_t instance, const std::string& topic)
    {
        message('A', Bytes().put(instance).put(id).put(topic));
    }

    template <class... Values>
    void data(std::uint16_t id, const Values&... values)
    {
        Bytes content;
        content.put(id);
        (content.put(values), ...);
        message('D', content);
    }

    void dropout(std::uint16_t duration_ms) { message('O', Bytes().put(duration_ms)); }

    void sync()
    {
        message('S', Bytes().put(std::array<std::uint8_t, 8>{0x2F, 0x73, 0x13, 0x20, 0x25, 0x0C, 0xBB, 0x12}));
    }

    Bytes log;
};

using Float3 = std::array<float, 3>;

/// A log of three instruments as PX4 1.11 writes them: vehicle_imu of three instances and the selected one in sensor_combined.
inline std::vector<std::uint8_t> ulog_of_three_imus(std::size_t rows)
{
    UlogWriter writer;
    writer.flags(0, 0);
    writer.format("vehicle_imu:uint64_t timestamp;uint64_t timestamp_sample;uint32_t accel_device_id;uint32_t gyro_device_id;"
                  "float[3] delta_angle;float[3] delta_velocity;uint16_t delta_angle_dt;uint16_t delta_velocity_dt;"
                  "uint8_t delta_velocity_clipping;uint8_t[3] _padding0;");
    writer.format("sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;int32_t accelerometer_timestamp_relative;"
                  "float[3] accelerometer_m_s2;uint32_t accelerometer_integral_dt;uint8_t accelerometer_clipping;uint8_t[3] _padding0;");
    for (std::uint8_t i = 0; i < 3; ++i) writer.subscribe(i, i, "vehicle_imu");
    writer.subscribe(7, 0, "sensor_combined");
    for (std::size_t row = 0; row < rows; ++row) {
        const auto time_us = static_cast<std::uint64_t>(2'000'000 + 5000 * row);
        const auto rate = static_cast<float>(row) * 0.01F;
        for (std::uint8_t i = 0; i < 3; ++i)
            writer.data(i, time_us + i * 700U + 500U, time_us + i * 700U, 100U + i, 200U + i, Float3{rate * 0.005F, 0, -rate * 0.005F},
                        Float3{0, 0, -0.049F}, std::uint16_t{5000}, std::uint16_t{5000}, std::uint8_t{0});
        writer.data(7, time_us, Float3{rate, 0, -rate}, 5000U, 0, Float3{0, 0, -9.8F}, 5000U, std::uint8_t{0});
        if (row % 50 == 0) writer.sync();
    }
    return writer.log.data;
}

}  // namespace quorient::recording::test
