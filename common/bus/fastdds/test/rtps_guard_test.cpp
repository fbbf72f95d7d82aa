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
