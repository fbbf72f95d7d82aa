#include "rtps_guard.hpp"

#include "rtps_submessage.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace quorient::bus::fastdds {

namespace {

constexpr std::uint8_t inline_qos_flag = 0x02;
constexpr std::uint8_t gap = 0x08;
constexpr std::uint8_t data = 0x15;
constexpr std::uint8_t data_fragment = 0x16;
constexpr std::uint16_t sentinel = 0x0001;
constexpr std::uint8_t statistics = 0x80;
constexpr std::size_t statistics_size = 56;

/// Fast DDS walks a gap number by number and stores unexpected numbers one by one. Writers here keep far fewer samples.
constexpr std::int64_t longest_gap = 65'536;

/// Fast DDS allocates the whole sample on its first fragment. Samples here are far smaller: each fits in one datagram.
constexpr std::uint32_t largest_sample = 65'536;

/// The form of data that describes participants and endpoints: a list of parameters.
constexpr std::uint8_t parameter_list_big_endian = 0x02;
constexpr std::uint8_t parameter_list_little_endian = 0x03;
constexpr std::uint16_t must_understand = 0x4000;

/// A parameter that begins with how many elements follow, and the least that one takes [RTPS 9.6.3.2, DDS-XTypes 7.6.3.1.1].
struct Counted {
    std::uint16_t id;
    std::size_t element_size;
};
constexpr std::array counted_parameters{
    Counted{0x0029, 4},  // partition: strings
    Counted{0x002c, 1},  // user data
    Counted{0x002d, 1},  // group data
    Counted{0x002e, 1},  // topic data
    Counted{0x0059, 8},  // properties: pairs of strings
    Counted{0x0073, 2},  // data representation
    Counted{0x8006, 8},  // Fast DDS's data sharing: domains
};

/// [RTPS 9.4.5.6]: reader, writer, first number, and behind the gap the base of a set.
bool is_sound_gap(const Submessage& content)
{
    if (content.size() < 28) return false;
    const std::int64_t first = content.sequence_number(8);
    const std::int64_t end = content.sequence_number(16);
    return first > 0 && end >= first && end - first <= longest_gap;
}

/// A parameter's elements fit into it.
bool fits(const Submessage& content, std::size_t place, std::size_t length)
{
    const auto id = static_cast<std::uint16_t>(content.half_word(place) & ~must_understand);
    const auto counted = std::ranges::find(counted_parameters, id, &Counted::id);
    if (counted == counted_parameters.end()) return true;
    return length >= 4 && content.word(place + 4) <= (length - 4) / counted->element_size;
}

/// @returns the end of the parameter list that begins there [RTPS 9.4.2.11]. Nothing where it is outside the submessage, or a parameter
/// claims more than it holds.
std::optional<std::size_t> end_of_parameters(const Submessage& content, std::size_t place)
{
    while (place + 4 <= content.size()) {
        const std::size_t length = content.half_word(place + 2);
        if (content.half_word(place) == sentinel) return place + 4;
        if (place + 4 + length > content.size() || !fits(content, place, length)) return std::nullopt;
        place += 4 + length;
    }
    return std::nullopt;
}

/// The description of a participant or an endpoint, behind the four octets of its encapsulation.
bool is_sound_description(const Submessage& content, std::size_t place)
{
    if (place + 4 > content.size()) return true;  // no description: the endpoint leaves
    const std::uint8_t form = content.octet(place + 1);
    if (form != parameter_list_big_endian && form != parameter_list_little_endian) return true;
    return end_of_parameters(content.in_order(form == parameter_list_little_endian), place + 4).has_value();
}

/// [RTPS 9.4.5.4, 9.4.5.5]: flags, offset of the inline QoS, reader, writer, number.
bool is_sound_data(const Submessage& content, std::uint8_t id, std::uint8_t flags)
{
    if (content.size() < 20) return false;
    std::size_t place = 4U + content.half_word(2);
    if ((flags & inline_qos_flag) != 0) {
        const auto end = end_of_parameters(content, place);
        if (!end) return false;
        place = *end;
    }
    const bool describes = id == data && is_builtin(content.octet(11));
    return !describes || is_sound_description(content, place);
}

/// [RTPS 9.4.5.5]: flags, reader, writer, number, fragments, fragment size, sample size.
bool is_sound_fragment(const Submessage& content)
{
    return content.size() >= 32 && content.word(28) <= largest_sample;
}

}  // namespace

bool is_sound_rtps(const std::uint8_t* bytes, std::size_t size)
{
    if (size < header_size || std::memcmp(bytes, "RTPS", 4) != 0) return false;
    for (std::size_t place = header_size; place < size;) {
        if (size - place < submessage_header_size) return false;
        const auto [id, flags, little, length] = submessage_header_at(bytes + place);
        const std::size_t left = size - place - submessage_header_size;
        if (length > left) return false;
        if (id == statistics) return length == statistics_size && length == left;
        // In all others a length of 0 means "to the end", which only submessages longer than a datagram need. Fast DDS's two parsers
        // disagree there.
        if (length == 0 && !may_be_empty(id) && left != 0) return false;
        const Submessage content(bytes + place + submessage_header_size, length, little);
        if (id == gap && !is_sound_gap(content)) return false;
        if ((id == data || id == data_fragment) && !is_sound_data(content, id, flags)) return false;
        if (id == data_fragment && !is_sound_fragment(content)) return false;
        place += submessage_header_size + length;
    }
    return true;
}

}  // namespace quorient::bus::fastdds
