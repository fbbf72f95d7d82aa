#include "formats.hpp"

#include "dataflash/dataflash_log.hpp"
#include "mcap/mcap_log.hpp"
#include "mimu_packet.hpp"
#include "ulog/ulog_log.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <string_view>

namespace quorient::recording {
namespace {

template <class Test>
bool any_packet(Bytes bytes, const Test& test)
{
    for (std::size_t at = 0; at + mimu::packet_size <= bytes.size(); ++at)
        if (test(bytes.subspan(at, mimu::packet_size))) return true;
    return false;
}

bool is_mimu_swapped(Bytes bytes)
{
    const auto little_endian = [](Bytes packet) {
        const std::uint16_t sum = mimu::checksum(packet);
        return mimu::starts_like_packet(packet) && packet[mimu::packet_size - 2] == (sum & 0xFFU) &&
               packet[mimu::packet_size - 1] == sum >> 8U;
    };
    if (any_packet(bytes, little_endian)) return true;
    std::vector<std::uint8_t> words(bytes.begin(), bytes.end());
    for (std::size_t at = 0; at + 1 < words.size(); at += 2) std::swap(words[at], words[at + 1]);
    return any_packet(words, mimu::intact);
}

bool is_text(Bytes bytes)
{
    const auto control = [](std::uint8_t byte) { return byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r'; };
    return std::find(bytes.begin(), bytes.end(), '\n') != bytes.end() && std::none_of(bytes.begin(), bytes.end(), control);
}

/// A telemetry log: an 8-byte time, highest byte first, before each MAVLink packet (0xFE or 0xFD, then the length of its payload).
bool is_tlog(Bytes bytes)
{
    constexpr std::size_t stamp_size = 8;
    constexpr std::size_t frame_v1 = 8;   // what a packet has besides its payload
    constexpr std::size_t frame_v2 = 12;
    const auto packet_at = [&](std::size_t at) {
        const bool there = bytes.size() >= at + stamp_size + 2 && bytes[at] == 0 && bytes[at + 1] < 0x10;
        return there && (bytes[at + stamp_size] == 0xFE || bytes[at + stamp_size] == 0xFD);
    };
    if (!packet_at(0)) return false;
    const std::size_t length = stamp_size + bytes[stamp_size + 1] + (bytes[stamp_size] == 0xFE ? frame_v1 : frame_v2);
    return bytes.size() < length + stamp_size + 2 || packet_at(length);
}

}  // namespace

Kind kind_of(Bytes beginning)
{
    const std::string_view text(reinterpret_cast<const char*>(beginning.data()), beginning.size());
    if (text.empty()) return Kind::empty;
    if (ulog::is_ulog(beginning)) return Kind::ulog;
    if (dataflash::is_binary(beginning)) return Kind::dataflash;
    if (mcap::is_mcap(beginning)) return Kind::mcap;
    if (text.starts_with("SQLite format 3")) return Kind::sqlite;
    if (text.starts_with("#ROSBAG V")) return Kind::ros1_bag;
    if (text.starts_with("H Product:Blackbox")) return Kind::blackbox;
    if (text.starts_with("PK\x03\x04")) return Kind::archive;
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return Kind::utf16;
    if (any_packet(beginning, mimu::intact)) return Kind::mimu4444;
    if (dataflash::is_text(beginning)) return Kind::dataflash_text;
    if (is_text(beginning)) return Kind::text;
    if (is_tlog(beginning)) return Kind::tlog;
    return is_mimu_swapped(beginning) ? Kind::mimu4444_swapped : Kind::unknown;
}

std::string why_not(Kind kind, std::size_t sniffed)
{
    switch (kind) {
        case Kind::empty: return "the file is empty";
        case Kind::mimu4444_swapped: return "MIMU4444 packets in the wrong byte order; convert the file to big-endian";
        case Kind::blackbox: return "a Betaflight blackbox log; convert it: blackbox_decode --unit-rotation deg/s FILE";
        case Kind::ros1_bag: return "a ROS 1 bag; convert it: mcap convert FILE.bag FILE.mcap";
        case Kind::tlog:
            return "a MAVLink telemetry log, a few samples a second; take the vehicle's own log (.bin), or convert it: mavlogdump.py "
                   "--format csv --types RAW_IMU FILE";
        case Kind::sqlite: return "a compressed ROS 2 bag of sqlite3; decompress it first, as by zstd -d FILE";
        case Kind::archive: return "a ZIP archive or a spreadsheet; unpack it, or export it as CSV";
        case Kind::utf16: return "text in UTF-16; save it as UTF-8";
        default:
            return fmt::format(
                "no known log in the first {} bytes; known are ArduPilot DataFlash (.bin, .log), PX4 ULog (.ulg), ROS 2 bags (.mcap, "
                ".db3), CSV, MIMU4444 and Xsens DOT",
                sniffed);
    }
}

}  // namespace quorient::recording
