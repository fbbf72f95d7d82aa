#include "quorient/bus/security.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <string>

namespace quorient::bus {

namespace {

using Start = std::array<std::uint8_t, 6>;

TEST(Subject, begins_the_guid_as_the_standard_has_it)
{
    // SHA-256 of 30 10 31 0e 30 0c 06 03 55 04 03 0c 05 "alice", computed apart from OpenSSL; a set bit, then its first 47.
    EXPECT_EQ(guid_start("alice"), (Start{0xc5, 0x5c, 0xd5, 0xc5, 0x9c, 0x97}));
    EXPECT_EQ(guid_start("voter-1.fastdds.3"), (Start{0xf9, 0x07, 0x6d, 0xd1, 0x20, 0x01}));
}

TEST(Subject, suits_one_vendor_and_not_the_other)
{
    unsigned fastdds = 0;
    for (int number = 0; number < 200; ++number) {
        const auto name = "node." + std::to_string(number);
        EXPECT_NE(suits(Vendor::fastdds, name), suits(Vendor::cyclonedds, name)) << name;
        fastdds += suits(Vendor::fastdds, name) ? 1 : 0;
    }
    EXPECT_GT(fastdds, 60U) << "a name is found soon";
    EXPECT_LT(fastdds, 140U);
}

TEST(Subject, puts_every_participant_of_cyclonedds_below_every_one_of_fastdds)
{
    Start highest_of_cyclonedds{}, lowest_of_fastdds{};
    lowest_of_fastdds.fill(0xff);
    for (int number = 0; number < 200; ++number) {
        const auto name = "node." + std::to_string(number);
        const auto start = guid_start(name);
        if (suits(Vendor::cyclonedds, name)) highest_of_cyclonedds = std::max(highest_of_cyclonedds, start);
        else lowest_of_fastdds = std::min(lowest_of_fastdds, start);
    }
    EXPECT_LT(highest_of_cyclonedds, lowest_of_fastdds);
}

TEST(Level, is_read_and_written_in_the_words_of_the_system_file)
{
    for (const auto level : {SecurityLevel::none, SecurityLevel::sign, SecurityLevel::encrypt})
        EXPECT_EQ(security_level_from(to_string(level)), level);
    EXPECT_FALSE(security_level_from("encrypted"));
}

}  // namespace

}  // namespace quorient::bus
