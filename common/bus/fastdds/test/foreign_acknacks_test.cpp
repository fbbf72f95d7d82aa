#include "../src/foreign_acknacks.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <vector>

namespace quorient::bus::fastdds {

namespace {

using Datagram = std::vector<std::uint8_t>;

constexpr std::uint16_t cyclone = 0x0110;
constexpr std::uint16_t eprosima = 0x010f;
constexpr std::uint32_t publications_writer = 0x3c2;
constexpr std::uint32_t user_writer = 0x103;

struct Acknack {
    std::uint32_t writer = publications_writer;
    std::uint32_t base = 1;
    std::vector<std::uint32_t> bitmap = {};
    std::uint32_t count = 0;
    bool final = false;
};

void append_word(Datagram& datagram, std::uint32_t value, bool little)
{
    for (unsigned i = 0; i < 4; ++i) datagram.push_back(static_cast<std::uint8_t>(value >> (little ? 8 * i : 24 - 8 * i)));
}

/// Header of RTPS 2.1 from this vendor.
Datagram header_of(std::uint16_t vendor)
{
    Datagram datagram(20, 0x55);
    const Datagram beginning{'R', 'T', 'P', 'S', 2, 1, static_cast<std::uint8_t>(vendor >> 8U), static_cast<std::uint8_t>(vendor)};
    std::copy(beginning.begin(), beginning.end(), datagram.begin());
    return datagram;
}

void append(Datagram& datagram, const Acknack& acknack, bool little)
{
    datagram.push_back(0x06);
    datagram.push_back(static_cast<std::uint8_t>((acknack.final ? 2 : 0) | (little ? 1 : 0)));
    const auto length = static_cast<std::uint8_t>(24 + 4 * acknack.bitmap.size());
    datagram.push_back(little ? length : 0);
    datagram.push_back(little ? 0 : length);
    append_word(datagram, 0x3c7, false);
    append_word(datagram, acknack.writer, false);
    append_word(datagram, 0, little);
    append_word(datagram, acknack.base, little);
    append_word(datagram, static_cast<std::uint32_t>(32 * acknack.bitmap.size()), little);
    for (const auto word : acknack.bitmap) append_word(datagram, word, little);
    append_word(datagram, acknack.count, little);
}

Datagram message(std::uint16_t vendor, const std::vector<Acknack>& acknacks, bool little)
{
    auto datagram = header_of(vendor);
    for (const auto& acknack : acknacks) append(datagram, acknack, little);
    return datagram;
}

std::optional<Datagram> understood(const Datagram& datagram)
{
    return with_understood_acknacks(datagram.data(), datagram.size());
}

TEST(ForeignAcknacks, that_have_heard_nothing_yet_are_counted_from_1_and_ask_from_0)
{
    for (const bool little : {true, false})
        EXPECT_EQ(understood(message(cyclone, {{}, {.writer = 0x4c2, .count = 6}}, little)),
                  message(cyclone, {{.base = 0, .count = 1}, {.writer = 0x4c2, .base = 0, .count = 7}}, little));
}

TEST(ForeignAcknacks, that_have_heard_a_heartbeat_keep_what_they_say)
{
    for (const bool little : {true, false}) {
        EXPECT_EQ(understood(message(cyclone, {{.count = 3, .final = true}}, little)),
                  message(cyclone, {{.count = 4, .final = true}}, little));
        EXPECT_EQ(understood(message(cyclone, {{.base = 5, .count = 3}}, little)), message(cyclone, {{.base = 5, .count = 4}}, little));
        EXPECT_EQ(understood(message(cyclone, {{.bitmap = {0xF000'0000, 1}, .count = 3}}, little)),
                  message(cyclone, {{.bitmap = {0xF000'0000, 1}, .count = 4}}, little));
    }
}

TEST(ForeignAcknacks, of_samples_and_of_the_own_vendor_are_left_alone)
{
    for (const bool little : {true, false}) {
        EXPECT_EQ(understood(message(cyclone, {{.writer = user_writer}}, little)), std::nullopt);
        EXPECT_EQ(understood(message(eprosima, {{}}, little)), std::nullopt);
        EXPECT_EQ(understood(header_of(cyclone)), std::nullopt);
    }
}

TEST(ForeignAcknacks, that_are_signed_are_left_alone)
{
    const Datagram begin{0x31, 1, 4, 0, 1, 2, 3, 4}, end{0x32, 1, 4, 0, 5, 6, 7, 8};
    const auto append_protected = [&](Datagram& datagram) {
        datagram.insert(datagram.end(), begin.begin(), begin.end());
        append(datagram, {}, true);
        datagram.insert(datagram.end(), end.begin(), end.end());
    };
    auto datagram = header_of(cyclone);
    append_protected(datagram);
    EXPECT_EQ(understood(datagram), std::nullopt);

    auto expected = datagram;
    append(datagram, {}, true);  // behind the end of the protection: a plain one
    append(expected, {.base = 0, .count = 1}, true);
    append_protected(datagram);
    append_protected(expected);
    EXPECT_EQ(understood(datagram), expected);
}

TEST(ForeignAcknacks, that_are_cut_or_claim_another_size_are_left_alone)
{
    const auto whole = message(cyclone, {{.bitmap = {7}}}, true);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const Datagram cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));  // a copy: sanitizers see its end
        EXPECT_EQ(understood(cut), std::nullopt) << size;
    }
    auto lying = whole;
    lying[40] = 0xFF;  // number of bits
    EXPECT_EQ(understood(lying), std::nullopt);
}

}  // namespace

}  // namespace quorient::bus::fastdds
