#include "quorient/settings/setting.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <array>
#include <cmath>

namespace quorient::settings {

namespace {

using testing::HasSubstr;

struct Filter {
    double corner_hz = 10;
    std::optional<double> damping{};
    unsigned order = 2;
    bool on = true;
};

const std::array<Setting<Filter>, 4> filter_record{{
    {"corner_hz", &Filter::corner_hz, "Hz", above_zero, "Where it begins to damp."},
    {"damping", &Filter::damping, "", probability, "How much."},
    {"order", &Filter::order, "", {.lowest = 1, .highest = 4}, "How steeply."},
    {"on", &Filter::on, "", {}, "Whether at all."},
}};

std::string problem(const Filter& filter)
{
    const auto checked = check<Filter>(filter_record, filter);
    return checked ? "" : checked.error();
}

}  // namespace

TEST(Bounds, hold_what_they_include_and_nothing_else)
{
    EXPECT_TRUE(not_negative.hold(0));
    EXPECT_FALSE(above_zero.hold(0));
    EXPECT_TRUE(above_zero.hold(1e300));
    EXPECT_FALSE(probability.hold(1));
    EXPECT_TRUE((Bounds{.lowest = 1, .highest = 32}.hold(32)));
    EXPECT_FALSE((Bounds{.lowest = 1, .highest = 32}.hold(33)));
}

TEST(Bounds, never_hold_what_is_not_finite)
{
    EXPECT_FALSE(any_number.hold(NAN));
    EXPECT_FALSE(any_number.hold(INFINITY));
    EXPECT_FALSE(above_zero.hold(INFINITY));
}

TEST(Bounds, are_put_in_words)
{
    EXPECT_EQ(any_number.text(), "");
    EXPECT_EQ(above_zero.text(), "above 0");
    EXPECT_EQ(not_negative.text(), "0 or more");
    EXPECT_EQ(probability.text(), "above 0 and below 1");
    EXPECT_EQ((Bounds{.lowest = 1, .highest = 32}.text()), "1 to 32");
    EXPECT_EQ((Bounds{.lowest = 0, .highest = 10, .lowest_included = false}.text()), "above 0 and at most 10");
}

TEST(Setting, is_refused_beyond_its_bounds_by_its_key_and_unit)
{
    EXPECT_EQ(problem({}), "");
    EXPECT_EQ(problem({.corner_hz = 0}), "corner_hz must be above 0 [Hz], got 0");
    EXPECT_EQ(problem({.corner_hz = NAN}), "corner_hz must be finite and above 0 [Hz], got nan");
    EXPECT_EQ(problem({.order = 5}), "order must be 1 to 4, got 5");
}

TEST(Setting, may_be_absent_where_it_is_optional)
{
    EXPECT_EQ(problem({.damping = std::nullopt}), "");
    EXPECT_EQ(problem({.damping = 0.5}), "");
    EXPECT_THAT(problem({.damping = 1.0}), HasSubstr("damping must be above 0 and below 1"));
}

}  // namespace quorient::settings
