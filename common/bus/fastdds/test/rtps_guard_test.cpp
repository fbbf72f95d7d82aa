#include "../src/rtps_guard.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace quorient::bus::fastdds {

namespace {

using Datagram = std::vector<std::uint8_t>;

/// What both vendors really send.
std::vector<Datagram> recorded()
{
    std::ifstream file{QUORIENT_SOURCE_DIR "/integration_tests/fuzz/datagrams.txt"};
    std::vector<Datagram> datagrams;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words{line};
        std::string port, hex;
        words >> port >> hex;
        auto& datagram = datagrams.emplace_back();
        for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
            datagram.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
    return datagrams;
}

bool sound(const Datagram& datagram)
{
    return is_sound_rtps(datagram.data(), datagram.size());
}

/// With Fast DDS's statistics at its end, of this length.
Datagram with_statistics(std::uint8_t length)
{
    Datagram datagram(24U + length);
    std::ranges::copy(std::array<std::uint8_t, 8>{'R', 'T', 'P', 'S', 2, 3, 1, 15}, datagram.begin());
    std::ranges::copy(std::array<std::uint8_t, 4>{0x80, 0x01, length, 0}, datagram.begin() + 20);
    return datagram;
}

/// One submessage in either byte order; its integers are in the sender's order.
Datagram with_words(std::uint8_t id, bool little, const std::vector<std::uint32_t>& words)
{
    Datagram datagram{'R', 'T', 'P', 'S', 2, 3, 1, 15};
    datagram.resize(20);
    const auto append = [&](std::uint32_t value, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; ++i)
            datagram.push_back(static_cast<std::uint8_t>(value >> 8U * static_cast<unsigned>(little ? i : bytes - 1 - i)));
    };
    append(id, 1);
    append(little ? 1 : 0, 1);
    append(static_cast<std::uint32_t>(4 * words.size()), 2);
    for (const auto word : words) append(word, 4);
    return datagram;
}

/// From the first number to before the end.
Datagram with_gap(std::uint64_t first, std::uint64_t end, bool little)
{
    const auto high = [](std::uint64_t number) { return static_cast<std::uint32_t>(number >> 32U); };
    const auto low = [](std::uint64_t number) { return static_cast<std::uint32_t>(number); };
    return with_words(0x08, little, {0x0102, 0x0103, high(first), low(first), high(end), low(end), 0});
}

Datagram with_fragment(std::uint32_t sample_size, bool little)
{
    return with_words(0x16, little, {0x1c, 0x0102, 0x0103, 0, 1, 1, 0x00010400, sample_size, 0});
}

TEST(RtpsGuard, lets_in_everything_that_either_vendor_sends)
{
    const auto datagrams = recorded();
    ASSERT_GT(datagrams.size(), 40U);
    for (const auto& datagram : datagrams) EXPECT_TRUE(sound(datagram));
}

TEST(RtpsGuard, refuses_statistics_of_another_length_or_in_the_middle)
{
    EXPECT_TRUE(sound(with_statistics(56)));
    EXPECT_FALSE(sound(with_statistics(55)));
    EXPECT_FALSE(sound(with_statistics(0)));
    auto more = with_statistics(56);
    more.resize(more.size() + 4);
    EXPECT_FALSE(sound(more));
}

TEST(RtpsGuard, refuses_what_is_cut_and_reads_nothing_behind_the_end)
{
    EXPECT_FALSE(is_sound_rtps(nullptr, 0));
    const auto whole = with_statistics(56);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const Datagram cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));  // a copy: sanitizers see its end
        EXPECT_EQ(sound(cut), size == 20) << size;
    }
}

TEST(RtpsGuard, refuses_inline_qos_that_reaches_beyond_its_submessage)
{
    const auto with_data = [](bool little, std::uint8_t flags, std::uint32_t parameter) {
        const std::uint32_t octets_to_inline_qos = little ? 16U << 16U : 16U;
        auto datagram = with_words(0x15, little, {octets_to_inline_qos, 0x0102, 0x0103, 0, 1, parameter, 0, little ? 1U : 1U << 16U, 0, 0});
        datagram[21] = static_cast<std::uint8_t>(datagram[21] | flags);
        return datagram;
    };
    for (const bool little : {true, false}) {
        const auto of_length = [&](std::uint32_t length) { return little ? length << 16U | 0x70U : 0x70U << 16U | length; };
        EXPECT_TRUE(sound(with_data(little, 0x06, of_length(4))));
        EXPECT_FALSE(sound(with_data(little, 0x06, of_length(400))));
        EXPECT_FALSE(sound(with_data(little, 0x06, of_length(12)))) << "no end in sight";
        EXPECT_TRUE(sound(with_data(little, 0x04, of_length(400)))) << "no inline QoS";
    }
}

TEST(RtpsGuard, refuses_descriptions_of_endpoints_that_promise_more_than_they_hold)
{
    constexpr std::uint32_t subscriptions_writer = 0x4c2, some_writer = 0x103, data_representation = 0x73;
    // One parameter of eight octets, its count and room for two data representations, in a list of this byte order.
    const auto with_description = [](std::uint32_t writer, bool little, std::uint32_t id, std::uint32_t count) {
        const std::uint32_t octets_to_inline_qos = little ? 16U << 16U : 16U;
        const std::uint32_t form = little ? 0x0300U : 0x0002'0000U;
        auto datagram = with_words(
            0x15, little,
            {octets_to_inline_qos, 0, writer, 0, 1, form, little ? 8U << 16U | id : id << 16U | 8U, count, 0, little ? 1U : 1U << 16U});
        datagram[21] = static_cast<std::uint8_t>(datagram[21] | 0x04);
        if (little) std::reverse(datagram.begin() + 32, datagram.begin() + 36);  // entities are octets in order
        return datagram;
    };
    for (const bool little : {true, false}) {
        EXPECT_TRUE(sound(with_description(subscriptions_writer, little, data_representation, 2)));
        EXPECT_FALSE(sound(with_description(subscriptions_writer, little, data_representation, 3)));
        EXPECT_FALSE(sound(with_description(subscriptions_writer, little, data_representation, 0xFFFF'FFFF)));
        EXPECT_FALSE(sound(with_description(subscriptions_writer, little, 0x4000U | data_representation, 3))) << "must be understood";
        EXPECT_TRUE(sound(with_description(subscriptions_writer, little, 0x1d, 0xFFFF'FFFF))) << "no count, but a time";
        EXPECT_TRUE(sound(with_description(some_writer, little, data_representation, 3))) << "an ordinary sample";
    }
}

TEST(RtpsGuard, refuses_gaps_that_would_be_walked_for_ever)
{
    for (const bool little : {true, false}) {
        EXPECT_TRUE(sound(with_gap(1, 1, little)));
        EXPECT_TRUE(sound(with_gap(0x1'0000'0000, 0x1'0001'0000, little)));
        EXPECT_FALSE(sound(with_gap(0x1'0000'0000, 0x1'0001'0001, little)));
        EXPECT_FALSE(sound(with_gap(1, 0x8000'0000, little)));
        EXPECT_FALSE(sound(with_gap(5, 4, little)));
        EXPECT_FALSE(sound(with_gap(0, 1, little)));
    }
}

TEST(RtpsGuard, refuses_fragments_of_samples_that_are_too_large)
{
    for (const bool little : {true, false}) {
        EXPECT_TRUE(sound(with_fragment(65'536, little)));
        EXPECT_FALSE(sound(with_fragment(65'537, little)));
        EXPECT_FALSE(sound(with_fragment(0xFFFF'FFFF, little)));
    }
}

TEST(RtpsGuard, refuses_a_submessage_without_a_length_that_is_not_the_last)
{
    auto datagram = with_gap(1, 1, true);
    datagram[22] = datagram[23] = 0;
    EXPECT_FALSE(sound(datagram)) << "to the end, or nothing: what follows is read in two ways";
    datagram[20] = 0x09;  // a time stamp that is taken back has no content
    datagram.resize(24);
    EXPECT_TRUE(sound(datagram));
}

TEST(RtpsGuard, refuses_another_protocol_and_lengths_beyond_the_end)
{
    auto other = with_statistics(56);
    other[0] = 'X';
    EXPECT_FALSE(sound(other));
    auto long_one = with_statistics(56);
    std::ranges::copy(std::array<std::uint8_t, 4>{0x15, 0x01, 0xFF, 0xFF}, long_one.begin() + 20);
    EXPECT_FALSE(sound(long_one));
}

}  // namespace

}  // namespace quorient::bus::fastdds
