#include "line_source.hpp"

#include <gtest/gtest.h>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

namespace quorient::recording {
namespace {

/// Any number that a table may hold, most of them short decimals.
std::string any_number(std::mt19937_64& random)
{
    const std::size_t digits = 1 + random() % 19;
    const std::size_t point = random() % (digits + 2);  // at most as many stand behind none
    std::string text = random() % 3 == 0 ? "-" : "";
    for (std::size_t i = 0; i < digits; ++i) {
        if (i == point) text += '.';
        text += static_cast<char>('0' + (random() % 4 == 0 ? 0 : random() % 10));
    }
    if (random() % 8 == 0) text += "e-" + std::to_string(random() % 40);
    return text;
}

TEST(Number, is_the_double_that_is_nearest_to_the_text)
{
    std::mt19937_64 random(11);
    for (int i = 0; i < 200'000; ++i) {
        const std::string text = any_number(random);
        const auto value = number(text);
        ASSERT_TRUE(value) << text;
        const double nearest = std::strtod(text.c_str(), nullptr);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(*value), std::bit_cast<std::uint64_t>(nearest)) << text;
    }
}

TEST(Number, is_nothing_where_the_text_is_none)
{
    for (const char* text : {"", "-", ".", "-.", "1.2.3", "1-2", "1 2", "--1", "12a", "0x10", "1,5", "1e"}) EXPECT_FALSE(number(text)) << text;
    for (const char* text : {"+1.5", "1.5", "1.50", "01.5", "15e-1"}) EXPECT_EQ(number(text), 1.5) << text;
    EXPECT_TRUE(std::signbit(*number("-0.0")));
}

}  // namespace
}  // namespace quorient::recording
