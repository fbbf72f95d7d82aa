#include "imu_messages.hpp"

#include <fmt/format.h>

namespace quorient::recording::dataflash {
namespace {

/// The first of several names that a message has; names changed over the years.
std::optional<std::size_t> any_place(const RecordFormat& format, std::initializer_list<std::string_view> names)
{
    for (const std::string_view name : names)
        if (const auto place = format.place(name)) return place;
    return std::nullopt;
}

/// The three fields `<stem>X`, `<stem>Y`, `<stem>Z`.
std::optional<std::array<std::size_t, 3>> three_places(const RecordFormat& format, std::string_view stem)
{
    std::array<std::size_t, 3> places{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto place = format.place(fmt::format("{}{}", stem, "XYZ"[k]));
        if (!place) return std::nullopt;
        places[k] = *place;
    }
    return places;
}

}  // namespace

std::string source_name(std::string_view message)
{
    const std::size_t last = message.find_last_not_of("0123456789");
    return std::string(message.substr(0, last == std::string_view::npos ? 0 : last + 1));
}

bool is_imu_name(std::string_view name)
{
    const std::string source = source_name(name);
    return source == "IMU" || source == "GYR" || source == "IMT";
}

std::optional<ImuMessage> imu_message(const RecordFormat& format, const Units& units)
{
    ImuMessage message;
    const auto sampled = format.place("SampleUS");
    const auto time = sampled ? sampled : any_place(format, {"TimeUS", "TimeMS"});
    const auto increments = three_places(format, "DelA");
    const auto covered = format.place("DelaT");
    const auto gyro = increments && covered ? increments : three_places(format, "Gyr");
    if (!time || !gyro) return std::nullopt;
    message.time = *time;
    message.time_unit_ns = format.fields[*time].name == "TimeMS" ? 1e6 : 1e3;
    message.stamps = sampled ? StampKind::sampling : StampKind::arrival;
    message.instance = any_place(format, {"I", "Instance"});
    message.gyro = *gyro;
    if (increments && covered) message.covered_s = covered;
    message.acceleration = three_places(format, "Acc");
    message.temperature = any_place(format, {"T", "Temp"});
    for (std::size_t k = 0; k < 3; ++k) message.gyro_factor[k] = units.to_radians(format.fields[message.gyro[k]]);
    return message;
}

std::string instrument_name(const std::string& message, std::optional<double> instance)
{
    return instance ? fmt::format("{}[{:.0f}]", message, *instance) : message;
}

}  // namespace quorient::recording::dataflash
