#include "imu_message.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace quorient::recording::ros {
namespace {

constexpr double no_such_value = -1;  // as the first element of a covariance

/// Numbers one after the other, each at a multiple of its own size (up to `widest`) from the beginning.
class Numbers {
public:
    Numbers(Bytes bytes, bool swapped, std::size_t widest) : bytes_(bytes), swapped_(swapped), widest_(widest) {}

    template <class Number>
    Number next()
    {
        const std::size_t alignment = std::min(sizeof(Number), widest_);
        at_ = (at_ + alignment - 1) / alignment * alignment;
        if (at_ + sizeof(Number) > bytes_.size()) {
            all_ = false;
            return {};
        }
        std::array<std::uint8_t, sizeof(Number)> raw;
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), raw.size(), raw.begin());
        if (swapped_) std::reverse(raw.begin(), raw.end());
        at_ += sizeof(Number);
        return std::bit_cast<Number>(raw);
    }

    void pass(std::size_t count)
    {
        all_ = all_ && count <= bytes_.size() - std::min(at_, bytes_.size());
        at_ += all_ ? count : 0;
    }

    std::array<double, 3> triple() { return {next<double>(), next<double>(), next<double>()}; }

    bool all() const { return all_; }

private:
    Bytes bytes_;
    bool swapped_;
    std::size_t widest_;
    std::size_t at_ = 0;
    bool all_ = true;
};

/// From the frame's name on both kinds have the same members.
std::optional<ImuMessage> parse_members(Numbers& numbers, std::int64_t stamp_ns)
{
    numbers.pass(numbers.next<std::uint32_t>());                       // the frame's name
    for (int i = 0; i < 4 + 9; ++i) (void)numbers.next<double>();      // orientation and its covariance
    ImuMessage message;
    message.stamp_ns = stamp_ns;
    message.angular_velocity_rad_s = numbers.triple();
    message.has_rate = numbers.next<double>() != no_such_value;
    for (int i = 0; i < 8; ++i) (void)numbers.next<double>();
    message.linear_acceleration_m_s2 = numbers.triple();
    message.has_acceleration = numbers.next<double>() != no_such_value;
    return numbers.all() ? std::optional(message) : std::nullopt;
}

std::int64_t in_ns(std::int64_t seconds, std::uint32_t nanoseconds)
{
    return seconds * 1'000'000'000 + nanoseconds;
}

}  // namespace

std::optional<ImuMessage> parse_cdr_imu(Bytes message)
{
    constexpr std::size_t encapsulation_size = 4;
    if (message.size() < encapsulation_size || message[0] != 0) return std::nullopt;
    const std::uint8_t kind = message[1];  // 0, 1: CDR; 6, 7: plain CDR2, which aligns to 4 bytes at most. Odd ones are little-endian.
    if (kind != 0 && kind != 1 && kind != 6 && kind != 7) return std::nullopt;
    const bool little = kind % 2 == 1;
    Numbers numbers(message.subspan(encapsulation_size), little != (std::endian::native == std::endian::little), kind >= 6 ? 4 : 8);
    const auto seconds = numbers.next<std::int32_t>();
    const auto nanoseconds = numbers.next<std::uint32_t>();
    return parse_members(numbers, in_ns(seconds, nanoseconds));
}

std::optional<ImuMessage> parse_stored_imu(Bytes message)
{
    constexpr std::array<std::uint8_t, 4> zstd_magic{0x28, 0xB5, 0x2F, 0xFD};
    if (message.size() < zstd_magic.size() || !std::equal(zstd_magic.begin(), zstd_magic.end(), message.begin())) return parse_cdr_imu(message);
    constexpr std::size_t longest_message = 4096;  // all members but the frame's name take 324 bytes
    const auto source = zstd_source(memory_source({message.begin(), message.end()}));
    std::array<std::uint8_t, longest_message> plain;
    return parse_cdr_imu(Bytes(plain).first(source->read(plain)));
}

std::optional<ImuMessage> parse_ros1_imu(Bytes message)
{
    Numbers numbers(message, false, 1);
    (void)numbers.next<std::uint32_t>();  // a number that publishers count up
    const auto seconds = numbers.next<std::uint32_t>();
    const auto nanoseconds = numbers.next<std::uint32_t>();
    return parse_members(numbers, in_ns(seconds, nanoseconds));
}

Instrument instrument_of(const std::string& topic)
{
    Instrument instrument;
    instrument.name = topic;
    instrument.source = "sensor_msgs/Imu";
    return instrument;
}

std::optional<InstrumentSample> sample_of(const ImuMessage& message, std::int64_t stored_ns)
{
    if (!message.has_rate) return std::nullopt;
    InstrumentSample sample;
    sample.time_ns = message.stamp_ns != 0 ? message.stamp_ns : stored_ns;
    sample.rate_rad_s = message.angular_velocity_rad_s;
    if (message.has_acceleration) sample.acceleration_m_s2 = message.linear_acceleration_m_s2;
    return sample;
}

}  // namespace quorient::recording::ros
