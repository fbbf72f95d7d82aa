#include "quorient/messages/name.hpp"
#include "quorient/messages/words.hpp"

#include <gtest/gtest.h>
#include <set>
#include <string>

namespace quorient {
namespace {

ClusterDescription arrays_of(std::size_t instruments, std::size_t axes_each, const char* prefix)
{
    ClusterDescription description;
    description.axis_count = static_cast<std::uint8_t>(instruments * axes_each);
    description.instrument_count = static_cast<std::uint8_t>(instruments);
    for (std::size_t i = 0; i < instruments; ++i) copy_text(prefix + std::to_string(i + 1), description.instrument_name[i]);
    for (std::size_t axis = 0; axis < instruments * axes_each; ++axis)
        description.instrument[axis] = static_cast<std::uint8_t>(axis / axes_each);
    return description;
}

TEST(AxisNames, are_those_of_the_instruments)
{
    const auto imus = arrays_of(8, 3, "IMU");
    EXPECT_EQ(axis_name(imus, 7), "IMU3 y");
    EXPECT_EQ(axis_names(imus, 0b1'0000'0000), "IMU3 z");
    EXPECT_EQ(axis_names(imus, 0b1000'0111), "IMU1, IMU3 y");
    const auto gyros = arrays_of(4, 1, "G");
    EXPECT_EQ(axis_name(gyros, 1), "G2");
    EXPECT_EQ(axis_names(gyros, 0b1010), "G2, G4");
    EXPECT_EQ(axis_names(gyros, 0), "no axis");
}

TEST(AxisNames, without_a_given_name_are_the_number_that_orders_take)
{
    auto gyros = arrays_of(4, 1, "G");
    gyros.instrument_name[1].fill(0);
    EXPECT_EQ(axis_name(gyros, 1), "axis 1");
    EXPECT_EQ(axis_name(gyros, 2), "G3");
    auto imus = arrays_of(2, 3, "IMU");
    imus.instrument_name[1].fill(0);
    EXPECT_EQ(axis_name(imus, 4), "instrument 1 y");
}

TEST(AxisNames, do_not_trust_a_description)
{
    auto broken = arrays_of(1, 3, "IMU");
    broken.axis_count = 255;
    broken.instrument.fill(200);
    EXPECT_EQ(axis_name(broken, 30), "axis 30");
    EXPECT_EQ(axis_names(broken, 1), "instrument 200 0");
    broken.instrument_name[0].fill('A');  // not terminated
    broken.instrument.fill(0);
    broken.axis_count = 1;
    EXPECT_EQ(axis_name(broken, 0), std::string(16, 'A'));
}

TEST(AxisNumbers, stand_in_while_there_is_no_description)
{
    EXPECT_EQ(axis_numbers(0b10), "axis 1");
    EXPECT_EQ(axis_numbers(0b1010), "axes 1, 3");
    EXPECT_EQ(axis_numbers(0), "no axis");
}

TEST(Words, differ_for_every_event)
{
    std::set<std::string_view> words;
    std::size_t named = 0;
    for (unsigned code = 0; code < 256; ++code) {
        const auto word = to_string(static_cast<EventCode>(code));
        if (word == "UNKNOWN") continue;
        words.insert(word);
        ++named;
    }
    EXPECT_EQ(words.size(), named);
    EXPECT_GT(named, 40U);
}

TEST(Names, are_cut_where_they_do_not_fit)
{
    Name<4> name;
    copy_text("abcdef", name);
    EXPECT_EQ(text_of(name), "abc");
    name.fill('x');
    EXPECT_EQ(text_of(name), "xxxx");
}

}  // namespace
}  // namespace quorient
