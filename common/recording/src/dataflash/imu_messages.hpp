#pragma once

#include "quorient/recording/instrument_log.hpp"
#include "record_format.hpp"
#include "stamps.hpp"

#include <cmath>
#include <string>
#include <string_view>

namespace quorient::recording::dataflash {

/// Which fields of a message hold what: found by name, since they differ by firmware and vehicle.
struct ImuMessage {
    std::size_t time = 0;
    double time_unit_ns = 1e3;
    std::optional<std::size_t> instance;
    std::array<std::size_t, 3> gyro{};
    std::array<double, 3> gyro_factor{1, 1, 1};  ///< to rad/s, or to rad where the fields are increments
    std::optional<std::array<std::size_t, 3>> acceleration;
    std::optional<std::size_t> temperature;
    std::optional<std::size_t> covered_s;  ///< the gyro fields are increments over this field's time
    StampKind stamps = StampKind::arrival;
};

/// Whether messages of this name may hold gyros: IMU, IMU2, GYR, GYR1, IMT, …
bool is_imu_name(std::string_view name);

/// @returns nothing if the message has no gyros.
std::optional<ImuMessage> imu_message(const RecordFormat& format, const Units& units);

/// What the log calls an instrument: "IMU2", or "IMU[1]" where a field has the instance.
std::string instrument_name(const std::string& message, std::optional<double> instance);

/// The message without the digit behind it: instruments of IMU, IMU2 and IMU3 belong together.
std::string source_name(std::string_view message);

/// Makes a sample of a record. @param value  double(std::size_t): the number in a field of this place
/// @returns nothing if its time is no time, or it covers none.
template <class Value>
std::optional<InstrumentSample> sample_of(const ImuMessage& message, const Value& value)
{
    const auto time_ns = log_time_ns(value(message.time), message.time_unit_ns);
    if (!time_ns) return std::nullopt;
    InstrumentSample sample;
    sample.time_ns = *time_ns;
    if (message.covered_s) sample.covered_s = value(*message.covered_s);
    if (message.covered_s && !(sample.covered_s > 0 && std::isfinite(sample.covered_s))) return std::nullopt;
    const double per_time = message.covered_s ? 1.0 / sample.covered_s : 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        sample.rate_rad_s[k] = value(message.gyro[k]) * message.gyro_factor[k] * per_time;
        if (message.acceleration) sample.acceleration_m_s2[k] = value((*message.acceleration)[k]);
    }
    if (message.temperature) sample.temperature_c = value(*message.temperature);
    return sample;
}

}  // namespace quorient::recording::dataflash
