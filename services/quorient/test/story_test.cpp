#include "launch/story.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quorient::launch {
namespace {

using testing::ElementsAre;

HealthEvent event(std::int64_t time_ms, EventCode code, std::string_view source, std::string_view text, AxisMask axes = 0,
                  Severity severity = Severity::warning_high)
{
    HealthEvent made;
    made.wall_time_ns = time_ms * 1'000'000;
    made.code = octet(code);
    made.severity = octet(severity);
    made.axes = axes;
    copy_text(source, made.source_name);
    copy_text(text, made.text);
    return made;
}

TEST(Story, tells_once_what_several_lanes_report_of_one_axis)
{
    Story story(10);
    for (const char* lane : {"fdi-c", "fdi-a", "fdi-b"}) story.add(event(8010, EventCode::isolated, lane, "ISOLATED G2", 0b10), "8.010 s");
    story.add(event(8020, EventCode::isolated, "fdi-a", "ISOLATED G4", 0b1000), "8.020 s");
    EXPECT_THAT(story.lines(), ElementsAre("    8.010 s  detectors a, b, c      ISOLATED G2", "    8.020 s  detector a             ISOLATED G4"));
}

TEST(Story, is_in_order_of_time_whatever_the_order_of_arrival)
{
    Story story(10);
    story.add(event(3000, EventCode::rolled_back, "attitude-a", "rolled back", 0b10, Severity::info), "3 s");
    story.add(event(2000, EventCode::isolated, "fdi-a", "ISOLATED G2", 0b10), "2 s");
    story.add(event(1000, EventCode::left_out, "fdi-a", "LEFT OUT G2", 0b10, Severity::warning_low), "1 s");
    ASSERT_EQ(story.lines().size(), 3U);
    EXPECT_THAT(story.lines()[0], testing::HasSubstr("LEFT OUT"));
    EXPECT_THAT(story.lines()[1], testing::HasSubstr("ISOLATED"));
    EXPECT_THAT(story.lines()[2], testing::HasSubstr("rolled back"));
}

TEST(Story, of_what_comes_and_goes_shows_the_newest_and_how_often)
{
    Story story(10);
    for (int i = 0; i < 50; ++i)
        story.add(
            event(1000 + 100 * i, EventCode::level_changed, "voter-1", i % 2 ? "SINGLE -> FULL" : "FULL -> SINGLE", 0, Severity::info),
            "1 s");
    EXPECT_THAT(story.lines(), ElementsAre("        1 s  voter-1                SINGLE -> FULL (x50)"));
    story.add(event(60'000, EventCode::level_changed, "voter-1", "FULL -> LOST"), "60 s");
    EXPECT_EQ(story.lines().size(), 2U) << "a new trouble is a new line";
}

TEST(Story, leaves_out_what_is_normal)
{
    Story story(10);
    for (const auto code : {EventCode::started, EventCode::ready, EventCode::goodbye, EventCode::new_epoch})
        story.add(event(1000, code, "fdi-a", "all is well", 0, Severity::info), "1 s");
    EXPECT_THAT(story.lines(), ElementsAre());
}

TEST(Story, keeps_the_newest_lines)
{
    Story story(3);
    for (int i = 0; i < 9; ++i) story.add(event(10'000 * i, EventCode::isolated, "fdi-a", "event " + std::to_string(i)), "");
    ASSERT_EQ(story.lines().size(), 3U);
    EXPECT_THAT(story.lines()[2], testing::HasSubstr("event 8"));
}

TEST(Story, names_processes_of_other_names_as_they_are)
{
    EXPECT_EQ(names_together({"attitude-b", "attitude-a"}), "integrators a, b");
    EXPECT_EQ(names_together({"voter-1", "fdi-a"}), "voter-1, fdi-a");
    EXPECT_EQ(names_together({"fdi-a"}), "detector a");
}

}  // namespace
}  // namespace quorient::launch
