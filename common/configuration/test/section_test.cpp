#include "quorient/configuration/section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quorient::configuration {

namespace {

using testing::HasSubstr;

/// A document and its problems, as a file "x.yaml".
struct Document {
    explicit Document(const char* text) : problems("x.yaml"), section(YAML::Load(text), "", problems) {}
    Problems problems;
    Section section;
};

TEST(Section, reads_values_of_every_form)
{
    Document document("rate: 2.5\ncount: 3\nname: demo\non: true\nlist: [1, 2.5]\nwords: [a, b]");
    double rate = 0;
    std::uint32_t count = 0;
    std::string name;
    bool on = false;
    std::vector<double> list;
    std::vector<std::string> words;
    document.section.number("rate", rate);
    document.section.whole("count", count);
    document.section.text("name", name);
    document.section.boolean("on", on);
    document.section.numbers("list", list);
    document.section.texts("words", words);
    document.section.finish();
    EXPECT_TRUE(document.problems.empty()) << document.problems.text();
    EXPECT_EQ(rate, 2.5);
    EXPECT_EQ(count, 3U);
    EXPECT_EQ(name, "demo");
    EXPECT_TRUE(on);
    EXPECT_EQ(list, (std::vector<double>{1, 2.5}));
    EXPECT_EQ(words, (std::vector<std::string>{"a", "b"}));
}

TEST(Section, suggests_the_key_that_was_meant)
{
    Document document("thresholds: 1\ntresholds: 2");
    double value = 0;
    document.section.number("thresholds", value);
    document.section.finish();
    EXPECT_THAT(document.problems.text(), HasSubstr("x.yaml:2:1: unknown key 'tresholds'; did you mean 'thresholds'?"));
}

TEST(Section, tells_the_unit_it_expected)
{
    Document document("sigma: 3 deg");
    double sigma = 1;
    document.section.number("sigma", sigma, {.lowest = 0, .lowest_included = false}, "rad");
    EXPECT_THAT(document.problems.text(), HasSubstr("x.yaml:1:8: sigma: expected a number [rad], got '3 deg'"));
    EXPECT_EQ(sigma, 1);
}

TEST(Section, tells_the_bound_that_was_broken)
{
    Document document("sigma: -0.001");
    double sigma = 1;
    document.section.number("sigma", sigma, {.lowest = 0, .lowest_included = false}, "rad");
    EXPECT_THAT(document.problems.text(), HasSubstr("must be above 0 [rad], got -0.001"));
}

TEST(Section, does_not_take_nan_for_a_number)
{
    Document document("sigma: .nan\nother: nan");
    double sigma = 1;
    document.section.number("sigma", sigma);
    document.section.number("other", sigma);
    EXPECT_THAT(document.problems.text(), HasSubstr("2 problems"));
}

TEST(Section, reports_all_problems_in_the_order_of_the_file)
{
    Document document("b: x\na: y");
    double value = 0;
    document.section.number("a", value);
    document.section.number("b", value);
    const auto text = document.problems.text();
    EXPECT_LT(text.find("b:"), text.find("a:"));
    EXPECT_THAT(text, HasSubstr("2 problems, nothing started"));
}

TEST(Section, names_the_place_inside_lists)
{
    Document document("lanes:\n  - {name: a, detector: {method: 1, speed: 2}}");
    auto lanes = document.section.sections("lanes");
    ASSERT_EQ(lanes.size(), 1U);
    auto detector = lanes[0].section("detector");
    std::string method;
    detector.text("method", method);
    detector.finish();
    EXPECT_THAT(document.problems.text(), HasSubstr("unknown key 'speed' in lanes[0].detector"));
}

TEST(Section, treats_an_absent_section_as_empty)
{
    Document document("a: 1");
    auto absent = document.section.section("voting");
    double value = 5;
    absent.number("patience", value);
    absent.finish();
    EXPECT_EQ(value, 5);
    EXPECT_TRUE(document.problems.empty());
}

TEST(Section, suggests_a_key_of_which_only_the_beginning_was_written)
{
    Document document("range: 1");
    double value = 0;
    for (const char* key : {"id", "name", "range_deg_s"}) document.section.number(key, value);
    document.section.finish();
    EXPECT_THAT(document.problems.text(), HasSubstr("unknown key 'range'; did you mean 'range_deg_s'?"));
}

TEST(Section, does_not_suggest_what_is_nothing_like_it)
{
    Document document("colour: 1");
    double value = 0;
    for (const char* key : {"id", "name", "range_deg_s"}) document.section.number(key, value);
    document.section.finish();
    EXPECT_THAT(document.problems.text(), testing::Not(HasSubstr("did you mean")));
}

TEST(Section, refuses_a_key_that_stands_there_twice)
{
    Document document("rate: 1\nname: a\nrate: 1");
    double rate = 0;
    std::string name;
    document.section.number("rate", rate);
    document.section.text("name", name);
    document.section.finish();
    EXPECT_EQ(document.problems.text(), "x.yaml:3:1: rate: stands here a second time, first in line 1\n1 problem, nothing started");
}

TEST(Section, tells_the_same_problem_once)
{
    Document document("detector: {a: 1, a: 2}");
    double value = 0;
    for (int reading = 0; reading < 2; ++reading) {
        auto detector = document.section.section("detector");
        detector.number("a", value);
    }
    EXPECT_THAT(document.problems.text(), HasSubstr("1 problem,"));
}

TEST(Section, reads_whole_numbers_and_nothing_else_as_such)
{
    for (const char* wrong : {"count: 2.5", "count: -1", "count: many", "count: 4294967296", "count: [1]"}) {
        Document document(wrong);
        std::uint32_t count = 7;
        document.section.whole("count", count);
        EXPECT_THAT(document.problems.text(), HasSubstr("x.yaml:1:8: count: expected a whole number, got")) << wrong;
        EXPECT_EQ(count, 7U) << wrong;
    }
    Document beyond("count: 33");
    std::uint32_t count = 7;
    beyond.section.whole("count", count, {.lowest = 1, .highest = 32});
    EXPECT_THAT(beyond.problems.text(), HasSubstr("count: must be 1 to 32, got 33"));
}

TEST(Section, names_the_entry_of_a_list_that_is_wrong)
{
    Document document("list: [1, 2, x]");
    std::vector<double> list;
    document.section.numbers("list", list);
    EXPECT_THAT(document.problems.text(), HasSubstr("x.yaml:1:14: list[2]: expected a number, got 'x'"));
}

TEST(Section, names_what_was_said_as_the_place_of_a_value_that_is_not_in_the_file)
{
    Document document("speed: -1\nrate: -1");
    document.problems.replaced("speed", "--set speed=-1");
    double value = 0;
    document.section.number("speed", value, settings::not_negative);
    document.section.number("rate", value, settings::not_negative);
    EXPECT_EQ(document.problems.text(),
              "--set speed=-1: speed: must be 0 or more, got -1\n"
              "x.yaml:2:7: rate: must be 0 or more, got -1\n"
              "2 problems, nothing started");
}

}  // namespace

}  // namespace quorient::configuration
