#include "quorient/runtime/yaml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quorient::runtime {

namespace {

using testing::HasSubstr;

/// A document and its problems, as a file "x.yaml".
struct Document {
    explicit Document(const char* text) : problems("x.yaml"), section(YAML::Load(text), "", problems) {}
    Problems problems;
    Section section;
};

TEST(Yaml, reads_values_of_every_form)
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

TEST(Yaml, suggests_the_key_that_was_meant)
{
    Document document("thresholds: 1\ntresholds: 2");
    double value = 0;
    document.section.number("thresholds", value);
    document.section.finish();
    EXPECT_THAT(document.problems.text(), HasSubstr("x.yaml:2:1: unknown key 'tresholds'; did you mean 'thresholds'?"));
}

TEST(Yaml, tells_the_unit_it_expected)
{
    Document document("sigma: 3 deg");
    double sigma = 1;
    document.section.number("sigma", sigma, {.lowest = 0, .lowest_included = false, .unit = "rad"});
    EXPECT_THAT(document.problems.text(), HasSubstr("x.yaml:1:8: sigma: expected a number [rad], got '3 deg'"));
    EXPECT_EQ(sigma, 1);
}

TEST(Yaml, tells_the_bound_that_was_broken)
{
    Document document("sigma: -0.001");
    double sigma = 1;
    document.section.number("sigma", sigma, {.lowest = 0, .lowest_included = false, .unit = "rad"});
    EXPECT_THAT(document.problems.text(), HasSubstr("must be above 0 [rad], got -0.001"));
}

TEST(Yaml, does_not_take_nan_for_a_number)
{
    Document document("sigma: .nan\nother: nan");
    double sigma = 1;
    document.section.number("sigma", sigma);
    document.section.number("other", sigma);
    EXPECT_THAT(document.problems.text(), HasSubstr("2 problems"));
}

TEST(Yaml, reports_all_problems_in_the_order_of_the_file)
{
    Document document("b: x\na: y");
    double value = 0;
    document.section.number("a", value);
    document.section.number("b", value);
    const auto text = document.problems.text();
    EXPECT_LT(text.find("b:"), text.find("a:"));
    EXPECT_THAT(text, HasSubstr("2 problems, nothing started"));
}

TEST(Yaml, names_the_place_inside_lists)
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

TEST(Yaml, treats_an_absent_section_as_empty)
{
    Document document("a: 1");
    auto absent = document.section.section("voting");
    double value = 5;
    absent.number("patience", value);
    absent.finish();
    EXPECT_EQ(value, 5);
    EXPECT_TRUE(document.problems.empty());
}

TEST(Yaml, assigns_a_value_deep_in_a_document)
{
    auto document = YAML::Load("source: {speed: 1, faults: [a]}");
    ASSERT_TRUE(assign(document, "source.speed=2"));
    ASSERT_TRUE(assign(document, "source.faults+=b"));
    ASSERT_TRUE(assign(document, "source.new.key=c"));
    EXPECT_EQ(document["source"]["speed"].as<int>(), 2);
    EXPECT_EQ(document["source"]["faults"].size(), 2U);
    EXPECT_EQ(document["source"]["new"]["key"].as<std::string>(), "c");
    EXPECT_FALSE(assign(document, "no assignment"));
}

}  // namespace

}  // namespace quorient::runtime
