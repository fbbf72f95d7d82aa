#include "orders/named_axes.hpp"

#include "quorient/messages/name.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quorient::cli {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two instruments of three axes, and a single gyro behind them.
ClusterDescription two_triads_and_a_gyro()
{
    ClusterDescription description;
    description.axis_count = 7;
    description.instrument_count = 3;
    for (std::size_t axis = 0; axis < 7; ++axis) description.instrument[axis] = static_cast<std::uint8_t>(axis / 3);
    copy_text("front", description.instrument_name[0]);
    copy_text("IMU 2", description.instrument_name[1]);
    copy_text("G7", description.instrument_name[2]);
    return description;
}

AxisMask named(const std::string& text)
{
    const auto axes = named_axes(axis_words(text), two_triads_and_a_gyro());
    EXPECT_TRUE(axes) << axes.error();
    return axes.value_or(0);
}

TEST(NamedAxes, are_numbers_names_and_whole_instruments)
{
    EXPECT_EQ(named("1"), 0b10U);
    EXPECT_EQ(named("front y"), 0b10U);
    EXPECT_EQ(named("IMU 2 z"), 0b100000U);
    EXPECT_EQ(named("G7"), 0b1000000U);
    EXPECT_EQ(named("front"), 0b111U);
    EXPECT_EQ(named("front x, 5+G7"), 0b1100001U);
}

TEST(NamedAxes, refuses_a_name_that_there_is_not_and_lists_those_that_there_are)
{
    const auto unknown = named_axes({"rear x"}, two_triads_and_a_gyro());
    ASSERT_FALSE(unknown);
    EXPECT_THAT(unknown.error(), AllOf(HasSubstr("'rear x'"), HasSubstr("front, IMU 2, G7"), HasSubstr("'front x'")));
    EXPECT_FALSE(named_axes({"24"}, two_triads_and_a_gyro()));
    EXPECT_FALSE(named_axes({""}, two_triads_and_a_gyro()));
    EXPECT_FALSE(named_axes({"-1"}, {}));
}

TEST(NamedAxes, are_divided_at_commas_and_plus_signs_and_not_at_blanks)
{
    EXPECT_THAT(axis_words("front y, 2+G7"), ElementsAre("front y", "2", "G7"));
    EXPECT_THAT(axis_words(""), ElementsAre(""));
}

}  // namespace
}  // namespace quorient::cli
