#pragma once

#include "definitions.hpp"
#include "quorient/recording/instrument_log.hpp"

namespace quorient::recording::ulog {

/// A time that a field states: microseconds as an integer, seconds as a float, by the firmware's age.
struct Duration {
    Field field;

    std::optional<double> seconds(Bytes message) const;
};

/// Three numbers: an array of three, or three fields.
using Triple = std::array<Field, 3>;

/// Where a topic keeps what of a gyro.
struct ImuTopic {
    Field time;
    Triple gyro;                      ///< rad/s, or rad where `gyro_over` is given
    std::optional<Duration> gyro_over;
    bool increments = false;          ///< the gyro's values are to be divided by `gyro_over`
    std::optional<Triple> acceleration;
    std::optional<Duration> acceleration_over;  ///< velocity increments
    std::optional<Field> temperature;
    std::optional<Field> clipping;    ///< bits of three axes, or a counter for each
    std::optional<Field> device;
};

/// sensor_gyro, vehicle_imu, sensor_combined; nothing for other topics or where fields are missing.
std::optional<ImuTopic> imu_topic(const Definitions& definitions, std::string_view message);

/// A sample of one message; nothing if it is cut, or its increments cover no time.
std::optional<InstrumentSample> sample_of(const ImuTopic& topic, Bytes message);

/// sensor_gyro_fifo: raw counts of up to 32 samples in one message.
struct FifoTopic {
    Field time;  ///< when the last sample was taken
    Field interval_us;
    Field scale;  ///< counts to rad/s
    Field count;
    std::array<Field, 3> counts;
    std::optional<Field> device;
};

std::optional<FifoTopic> fifo_topic(const Definitions& definitions, std::string_view message);

/// Appends the message's samples, oldest first.
void samples_of(const FifoTopic& topic, Bytes message, std::vector<InstrumentSample>& samples);

}  // namespace quorient::recording::ulog
