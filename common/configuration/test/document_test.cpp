#include "quorient/configuration/document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>

namespace quorient::configuration {

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& text)
{
    const auto parsed = parse_yaml(text, "x.yaml");
    return parsed ? "accepted" : parsed.error().text();
}

std::string set(YAML::Node document, const std::string& assignment)
{
    const auto path = assign(document, assignment);
    return path ? *path : path.error();
}

}  // namespace

TEST(Document, reads_keys_and_values)
{
    const auto parsed = parse_yaml("a: 1\nb: {c: [1, 2]}\n", "x.yaml");
    ASSERT_TRUE(parsed) << parsed.error().text();
    EXPECT_EQ((*parsed)["b"]["c"][1].Scalar(), "2");
}

TEST(Document, refuses_a_tab_as_indentation_in_words_that_say_so)
{
    for (const char* text : {"a:\n\tb: 1\n", "a: 1\n\tb: 1\n", "a:\n  b: 1\n\tc: 2\n"})
        EXPECT_THAT(refusal(text), HasSubstr("a tab indents this line: YAML wants spaces")) << text;
    EXPECT_THAT(refusal("a:\n  b: 1\n\tc: 2\n"), StartsWith("x.yaml:3:1: "));
}

TEST(Document, takes_a_tab_between_a_key_and_its_value)
{
    EXPECT_EQ(refusal("a:\t1\n"), "accepted");
}

TEST(Document, explains_what_is_not_closed_or_badly_indented)
{
    EXPECT_THAT(refusal("a: {b: 1\nc: 2\n"), AllOf(StartsWith("x.yaml:2:"), HasSubstr("is not closed by '}'")));
    EXPECT_THAT(refusal("a: [1, 2\nc: 2\n"), AllOf(StartsWith("x.yaml:2:"), HasSubstr("is not closed by ']'")));
    EXPECT_THAT(refusal("a:\n  b: 1\n c: 2\n"), AllOf(StartsWith("x.yaml:3:2: "), HasSubstr("indentation")));
    EXPECT_THAT(refusal("a: 1\n b: 2\n"), AllOf(StartsWith("x.yaml:2:3: "), HasSubstr("indentation")));
    EXPECT_THAT(refusal("a:1\nb: 2\n"), AllOf(StartsWith("x.yaml:2:2: "), HasSubstr("'key: value', with a space")));
    EXPECT_THAT(refusal("a: @b\n"), AllOf(StartsWith("x.yaml:1:4: "), HasSubstr("quotes")));
    EXPECT_THAT(refusal("a: *b\n"), HasSubstr("quotes"));
}

TEST(Document, refuses_what_holds_no_mapping)
{
    EXPECT_THAT(refusal(""), HasSubstr("x.yaml: is empty"));
    EXPECT_THAT(refusal("# nothing\n"), HasSubstr("x.yaml: is empty"));
    EXPECT_THAT(refusal("[1, 2]"), HasSubstr("expected a mapping of keys to values"));
    EXPECT_THAT(refusal("just words"), HasSubstr("expected a mapping of keys to values"));
    EXPECT_THAT(refusal("a: 1\n---\nb: 2\n"), HasSubstr("2 documents"));
}

TEST(Document, tells_a_directory_from_a_file_that_is_not_there)
{
    EXPECT_THAT(load_yaml(testing::TempDir()).error().text(), HasSubstr("is a directory, expected a file"));
    EXPECT_THAT(load_yaml("/nowhere/x.yaml").error().text(), AllOf(HasSubstr("cannot be read"), HasSubstr("No such file")));
}

TEST(Document, that_never_ends_is_refused_with_the_limit)
{
    EXPECT_THAT(load_yaml("/dev/zero").error().text(), AllOf(HasSubstr("/dev/zero"), HasSubstr("cannot be read: more than 16 MB")));
}

TEST(Document, is_read_from_a_file)
{
    const auto file = std::filesystem::path(testing::TempDir()) / "document_test.yaml";
    std::ofstream(file) << "a: {b: }";
    EXPECT_TRUE(load_yaml(file.string()));
    std::ofstream(file) << "a: {b: 1";
    EXPECT_THAT(load_yaml(file.string()).error().text(), StartsWith(file.string() + ":"));
    std::filesystem::remove(file);
}

TEST(Document, knows_the_place_of_a_key_or_of_the_mapping_that_lacks_it)
{
    const auto document = YAML::Load("lanes:\n  - {name: a, detector: {sigma: 1}}\n  - name: b\n");
    const auto place = [&](const char* path) {
        const auto mark = place_of(document, path);
        return std::pair{mark.line + 1, mark.column + 1};
    };
    EXPECT_EQ(place("lanes[0].detector.sigma"), (std::pair{2, 33}));
    EXPECT_EQ(place("lanes[0].detector.pfa"), (std::pair{2, 25}));
    EXPECT_EQ(place("lanes[1].name"), (std::pair{3, 11}));
    EXPECT_EQ(place("lanes[1].detector.sigma"), (std::pair{3, 5}));
    EXPECT_EQ(place("voters[1].name"), (std::pair{1, 1}));
}

TEST(Assignment, assigns_a_value_deep_in_a_document)
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

TEST(Assignment, reaches_into_lists_by_number_and_by_name)
{
    auto document = YAML::Load("lanes: [{name: a, detector: {sigma: 1}}, {name: b}]");
    EXPECT_EQ(set(document, "lanes.b.detector.sigma=2"), "lanes[1].detector.sigma");
    EXPECT_EQ(set(document, "lanes[0].detector.sigma=3"), "lanes[0].detector.sigma");
    EXPECT_EQ(set(document, "lanes.a.faults+=x"), "lanes[0].faults[0]");
    EXPECT_EQ(document["lanes"][1]["detector"]["sigma"].Scalar(), "2");
    EXPECT_EQ(document["lanes"][0]["detector"]["sigma"].Scalar(), "3");
}

TEST(Assignment, is_refused_where_it_leads_nowhere)
{
    auto document = YAML::Load("name: x\nlanes: [{name: a}]");
    EXPECT_THAT(set(document, "lanes.c.sigma=1"), HasSubstr("there is no item 'c' in 'lanes'"));
    EXPECT_THAT(set(document, "lanes[1].sigma=1"), HasSubstr("there is no item '1' in 'lanes'"));
    EXPECT_THAT(set(document, "name.first=1"), HasSubstr("'name' is a value"));
    EXPECT_THAT(set(document, "name+=1"), HasSubstr("no list to append to"));
    EXPECT_THAT(set(document, "name=[1"), HasSubstr("is not closed by ']'"));
    EXPECT_THAT(set(document, "=1"), HasSubstr("no assignment"));
}

TEST(Document, takes_a_problem_that_was_found_after_reading)
{
    const auto document = YAML::Load("lanes: [{name: a}]");
    Problems problems{"x.yaml"};
    report(problems, document, "lanes[0].name", "is taken");
    report(problems, document, "lanes[0].name", "is taken");
    EXPECT_EQ(problems.lines(), "x.yaml:1:16: lanes[0].name: is taken");
}

}  // namespace quorient::configuration
