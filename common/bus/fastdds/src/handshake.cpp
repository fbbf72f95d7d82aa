#include "handshake.hpp"

#include "rtps_submessage.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <thread>

namespace quorient::bus::fastdds {

namespace {

constexpr std::uint8_t data_id = 0x15;
constexpr std::uint8_t fragment_id = 0x16;

/// Place in the content of either [RTPS 9.4.5.4]: behind flags, an offset and the reader.
constexpr std::size_t writer = 8;
constexpr std::array<std::uint8_t, 4> stateless_message_writer{0x00, 0x02, 0x01, 0xc3};

}  // namespace

bool is_handshake(const std::uint8_t* data, std::size_t size)
{
    for (std::size_t place = header_size; place + submessage_header_size <= size;) {
        const auto header = submessage_header_at(data + place);
        place += submessage_header_size;
        const bool carries = header.id == data_id || header.id == fragment_id;
        if (carries && std::min(header.length, size - place) >= writer + stateless_message_writer.size() &&
            std::ranges::equal(stateless_message_writer, std::span{data + place + writer, stateless_message_writer.size()}))
            return true;
        place += header.length;
    }
    return false;
}

std::chrono::nanoseconds HandshakePause::left() const
{
    return std::max(std::chrono::nanoseconds{last_ - now()} + length, std::chrono::nanoseconds{0});
}

void HandshakePause::lock_after(std::unique_lock<std::mutex>& lock) const
{
    const std::int64_t latest = now() + std::chrono::nanoseconds{longest}.count();
    for (lock.lock(); left() > std::chrono::nanoseconds{0} && now() < latest; lock.lock()) {
        lock.unlock();
        std::this_thread::sleep_for(std::min(left(), std::chrono::nanoseconds{latest - now()}));
    }
}

}  // namespace quorient::bus::fastdds
