#include "imu_topics.hpp"

#include "stamps.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::recording::ulog {
namespace {

std::optional<Triple> array_of_three(const Definitions& definitions, std::string_view message, std::string_view name)
{
    const auto field = definitions.field(message, name);
    if (!field || field->count != 3 || !field->is_float()) return std::nullopt;
    Triple triple;
    triple.fill(*field);
    const std::size_t size = field->type == NumberType::float32 ? 4 : 8;
    for (std::size_t k = 0; k < 3; ++k) {
        triple[k].offset += k * size;
        triple[k].count = 1;
    }
    return triple;
}

std::optional<Triple> three_fields(const Definitions& definitions, std::string_view message, std::array<std::string_view, 3> names)
{
    Triple triple;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto field = definitions.field(message, names[k]);
        if (!field || !field->is_float()) return std::nullopt;
        triple[k] = *field;
    }
    return triple;
}

std::optional<Duration> duration(const Definitions& definitions, std::string_view message, std::string_view name)
{
    const auto field = definitions.field(message, name);
    return field ? std::optional(Duration{*field}) : std::nullopt;
}

/// The instant of the sample, or, in older logs, of the message.
std::optional<Field> time_of(const Definitions& definitions, std::string_view message)
{
    const auto sampled = definitions.field(message, "timestamp_sample");
    return sampled ? sampled : definitions.field(message, "timestamp");
}

/// The gyro's values: of old firmware the integral besides the rate, which leaves nothing out between two samples.
void find_gyro(const Definitions& definitions, std::string_view message, ImuTopic& topic, bool& found)
{
    std::optional<Triple> gyro;
    if (message == "vehicle_imu") {
        gyro = array_of_three(definitions, message, "delta_angle");
        topic.gyro_over = duration(definitions, message, "delta_angle_dt");
        topic.increments = true;
    } else if (message == "sensor_combined") {
        gyro = array_of_three(definitions, message, "gyro_rad");
        topic.gyro_over = duration(definitions, message, "gyro_integral_dt");
    } else if (message == "sensor_gyro") {
        gyro = three_fields(definitions, message, {"x_integral", "y_integral", "z_integral"});
        topic.gyro_over = duration(definitions, message, "integral_dt");
        topic.increments = gyro && topic.gyro_over;
        if (!topic.increments) gyro = three_fields(definitions, message, {"x", "y", "z"});
    }
    found = gyro && (!topic.increments || topic.gyro_over);
    if (found) topic.gyro = *gyro;
}

}  // namespace

std::optional<double> Duration::seconds(Bytes message) const
{
    const auto value = number_at(message, field);
    if (!value) return std::nullopt;
    return field.is_float() ? *value : *value * 1e-6;
}

std::optional<ImuTopic> imu_topic(const Definitions& definitions, std::string_view message)
{
    ImuTopic topic;
    const auto time = time_of(definitions, message);
    bool found = false;
    find_gyro(definitions, message, topic, found);
    if (!time || !found) return std::nullopt;
    topic.time = *time;
    topic.acceleration = array_of_three(definitions, message, "accelerometer_m_s2");
    if (!topic.acceleration) {
        topic.acceleration = array_of_three(definitions, message, "delta_velocity");
        topic.acceleration_over = duration(definitions, message, "delta_velocity_dt");
        if (!topic.acceleration_over) topic.acceleration.reset();
    }
    topic.temperature = definitions.field(message, "temperature");
    for (const char* const name : {"delta_angle_clipping", "gyro_clipping", "clip_counter"})
        if (!topic.clipping) topic.clipping = definitions.field(message, name);
    topic.device = definitions.field(message, "gyro_device_id");
    if (!topic.device) topic.device = definitions.field(message, "device_id");
    return topic;
}

std::optional<InstrumentSample> sample_of(const ImuTopic& topic, Bytes message)
{
    InstrumentSample sample;
    const auto time_us = number_at(message, topic.time);
    const auto time_ns = time_us ? log_time_ns(*time_us, 1e3) : std::nullopt;
    if (!time_ns) return std::nullopt;
    sample.time_ns = *time_ns;
    if (topic.gyro_over) sample.covered_s = topic.gyro_over->seconds(message).value_or(0);
    if (!(sample.covered_s >= 0) || !std::isfinite(sample.covered_s) || (topic.increments && sample.covered_s == 0)) return std::nullopt;
    const double over_s = topic.increments ? sample.covered_s : 1.0;
    const double accelerating_s = topic.acceleration_over ? topic.acceleration_over->seconds(message).value_or(0) : 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto gyro = number_at(message, topic.gyro[k]);
        if (!gyro) return std::nullopt;
        sample.rate_rad_s[k] = *gyro / over_s;
        if (topic.acceleration && accelerating_s > 0)
            sample.acceleration_m_s2[k] = number_at(message, (*topic.acceleration)[k]).value_or(not_logged) / accelerating_s;
    }
    if (topic.temperature) sample.temperature_c = number_at(message, *topic.temperature).value_or(not_logged);
    if (topic.clipping) {
        std::uint8_t clipped = 0;
        for (std::size_t k = 0; k < topic.clipping->count && k < 3; ++k) {
            const double value = number_at(message, *topic.clipping, k).value_or(0);
            if (topic.clipping->count == 1) clipped = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)) & 7U;
            else if (value > 0) clipped = static_cast<std::uint8_t>(clipped | 1U << k);
        }
        sample.clipped = clipped;
    }
    return sample;
}

std::optional<FifoTopic> fifo_topic(const Definitions& definitions, std::string_view message)
{
    if (message != "sensor_gyro_fifo") return std::nullopt;
    const auto time = time_of(definitions, message);
    const auto interval = definitions.field(message, "dt");
    const auto scale = definitions.field(message, "scale");
    const auto count = definitions.field(message, "samples");
    const auto x = definitions.field(message, "x");
    const auto y = definitions.field(message, "y");
    const auto z = definitions.field(message, "z");
    if (!time || !interval || !scale || !count || !x || !y || !z) return std::nullopt;
    return FifoTopic{*time, *interval, *scale, *count, {*x, *y, *z}, definitions.field(message, "device_id")};
}

void samples_of(const FifoTopic& topic, Bytes message, std::vector<InstrumentSample>& samples)
{
    const double end_us = number_at(message, topic.time).value_or(not_logged);
    const double interval_us = number_at(message, topic.interval_us).value_or(0);
    const double scale = number_at(message, topic.scale).value_or(0);
    const double count = std::min(number_at(message, topic.count).value_or(0), static_cast<double>(topic.counts[0].count));
    if (!(interval_us > 0)) return;
    for (double i = 0; i < count; ++i) {
        InstrumentSample sample;
        const auto time_ns = log_time_ns(end_us - (count - 1 - i) * interval_us, 1e3);
        if (!time_ns) return;
        sample.time_ns = *time_ns;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto count_of_axis = number_at(message, topic.counts[k], static_cast<std::size_t>(i));
            if (!count_of_axis) return;
            sample.rate_rad_s[k] = *count_of_axis * scale;
        }
        samples.push_back(sample);
    }
}

}  // namespace quorient::recording::ulog
