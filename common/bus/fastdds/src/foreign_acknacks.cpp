#include "foreign_acknacks.hpp"

#include "rtps_submessage.hpp"

namespace quorient::bus::fastdds {

namespace {

constexpr std::uint8_t acknack = 0x06;
constexpr std::uint8_t final_flag = 0x02;
constexpr std::uint16_t vendor_eprosima = 0x010f;
constexpr std::uint8_t protection_begins = 0x31;  ///< SEC_PREFIX [DDS Security 7.3.6]
constexpr std::uint8_t protection_ends = 0x32;    ///< SEC_POSTFIX

/// Places in an ACKNACK's content [RTPS 9.4.5.3]: reader, writer, base and size of a set, its bitmap, a count.
constexpr std::size_t writer_kind = 7;
constexpr std::size_t base = 8;
constexpr std::size_t number_of_bits = 16;
constexpr std::size_t bitmap = 20;

void write_word(std::uint8_t* bytes, std::uint32_t value, bool little)
{
    for (std::size_t i = 0; i < 4; ++i) bytes[little ? i : 3 - i] = static_cast<std::uint8_t>(value >> (8 * i));
}

bool is_for_a_builtin_writer(const Submessage& content)
{
    if (content.size() < bitmap + 4 || !is_builtin(content.octet(writer_kind))) return false;
    const std::size_t words = (std::size_t{content.word(number_of_bits)} + 31) / 32;
    return content.size() == bitmap + 4 * words + 4;
}

void make_understood(std::uint8_t* bytes, const SubmessageHeader& header)
{
    const Submessage content(bytes, header.length, header.little);
    const std::size_t count = header.length - 4;
    write_word(bytes + count, content.word(count) + 1, header.little);
    const bool asks_for_a_heartbeat = (header.flags & final_flag) == 0 && content.word(number_of_bits) == 0;
    if (asks_for_a_heartbeat && content.sequence_number(base) == 1) write_word(bytes + base + 4, 0, header.little);
}

}  // namespace

std::optional<std::vector<std::uint8_t>> with_understood_acknacks(const std::uint8_t* data, std::size_t size)
{
    constexpr std::size_t vendor = 6;
    if (size < header_size || (data[vendor] << 8U | data[vendor + 1]) == vendor_eprosima) return std::nullopt;
    std::optional<std::vector<std::uint8_t>> changed;
    bool is_protected = false;
    for (std::size_t place = header_size; place + submessage_header_size <= size;) {
        const auto header = submessage_header_at(data + place);
        place += submessage_header_size;
        if (header.length > size - place) break;
        is_protected = header.id == protection_begins || (is_protected && header.id != protection_ends);
        if (header.id == acknack && !is_protected && is_for_a_builtin_writer({data + place, header.length, header.little})) {
            if (!changed) changed.emplace(data, data + size);
            make_understood(changed->data() + place, header);
        }
        place += header.length;
    }
    return changed;
}

}  // namespace quorient::bus::fastdds
