#include "run_verb.hpp"
#include "verbs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace quorient::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;

struct Run : cli::Output {
    json object() const { return json::parse(out); }
};

Run run(const std::string& arguments)
{
    Program program{"quorient", ""};
    add_layout(program);
    return Run{run_program(program, "layout " + arguments)};
}

class AxesFile : public testing::Test {
protected:
    std::string written(const std::string& text)
    {
        std::ofstream(path_) << text;
        return path_.string();
    }
    ~AxesFile() override { std::filesystem::remove(path_); }

private:
    const testing::TestInfo* test_ = testing::UnitTest::GetInstance()->current_test_info();
    std::filesystem::path path_ = std::filesystem::path(testing::TempDir()) / (std::string(test_->name()) + ".csv");
};

TEST(LayoutVerb, has_the_fields_of_the_contract_in_order)
{
    const auto object = nlohmann::ordered_json::parse(run("cone-6 --json").out);
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    EXPECT_THAT(keys, testing::ElementsAre("name", "axes", "instrument", "eigenvalues", "trace", "volume", "condition", "minimum_angle_deg",
                                           "parity_matrix", "parity_per_axis", "J", "J_ij", "F_d1", "F_d2", "F_d2_partner_excluded",
                                           "detectable", "isolable"));
    EXPECT_EQ(object["name"], "cone-6");
    EXPECT_EQ(object["axes"].size(), 6U);
    EXPECT_EQ(object["parity_matrix"].size(), 3U);
    EXPECT_EQ(object["parity_per_axis"][5][5], 1);
    EXPECT_TRUE(object["F_d2_partner_excluded"].is_null());
    EXPECT_EQ(object["detectable"], 3);
    EXPECT_EQ(object["isolable"], 1);
}

TEST(LayoutVerb, leaves_axes_out)
{
    const auto object = run("cone-6 --without 1,0 --json").object();
    EXPECT_EQ(object["axes"].size(), 4U);
    EXPECT_EQ(object["instrument"], json({2, 3, 4, 5}));
    EXPECT_EQ(object["axis"], json({2, 3, 4, 5}));
    EXPECT_NEAR(object["eigenvalues"][0], 3, 1e-12);
    EXPECT_NEAR(object["condition"], 6, 1e-12);
    EXPECT_EQ(object["detectable"], 1);
    EXPECT_EQ(object["isolable"], 0);
}

TEST(LayoutVerb, keeps_the_numbers_of_the_axes_that_are_left)
{
    const std::string text = run("cone-6 --without 1,3").out;
    for (const char* row : {"\n   0          0 ", "\n   2          2 ", "\n   4          4 ", "\n   5          5 "})
        EXPECT_THAT(text, HasSubstr(row));
    EXPECT_THAT(text, testing::Not(HasSubstr("\n   1 ")));
    EXPECT_THAT(text, testing::Not(HasSubstr("\n   3 ")));
}

TEST(LayoutVerb, writes_null_for_what_is_undefined)
{
    const auto three = run("orthogonal-3 --json").object();
    EXPECT_EQ(three["parity_matrix"], json::array());
    EXPECT_TRUE(three["F_d1"].is_null());
    EXPECT_TRUE(three["F_d2"].is_null());
    EXPECT_TRUE(three["J_ij"][0][0].is_null());
    EXPECT_EQ(three["trace"], 3);

    const auto two = run("orthogonal-3 --without 2 --json").object();
    EXPECT_TRUE(two["trace"].is_null());
    EXPECT_EQ(two["eigenvalues"], json({nullptr, nullptr, nullptr}));
    EXPECT_EQ(two["detectable"], 0);

    const auto none = run("orthogonal-3 --without 0,1,2 --json").object();
    EXPECT_EQ(none["axes"], json::array());
    EXPECT_TRUE(none["minimum_angle_deg"].is_null());
}

TEST(LayoutVerb, states_both_rules_for_two_axis_gyros)
{
    const auto object = run("tdof-coplanar --json").object();
    EXPECT_NEAR(object["F_d2"], 4.2893, 5e-5);
    EXPECT_NEAR(object["F_d2_partner_excluded"], 3.6951, 5e-5);
}

TEST(LayoutVerb, lists_the_catalogue_without_a_name)
{
    EXPECT_THAT(run("").out, HasSubstr("two-cones:A1,A2,D"));
    EXPECT_EQ(run("--json").object()[3]["name"], "cone-3-axis");
}

TEST(LayoutVerb, reads_to_a_human)
{
    EXPECT_THAT(run("tetrad").out, HasSubstr("1 detectable, 0 isolable"));
}

TEST(LayoutVerb, prints_the_papers_tables_with_reasons_for_what_differs)
{
    const auto tables = run("--table --json").object();
    ASSERT_EQ(tables["paper_004_table_4"].size(), 11U);
    for (const auto& row : tables["paper_004_table_4"]) {
        if (!row["difference"].is_null() && std::abs(row["difference"].get<double>()) < 1e-9) EXPECT_EQ(row["reason"], "");
        else EXPECT_NE(row["reason"], "") << row;
    }
    unsigned errata = 0;
    for (const auto& row : tables["paper_002_accuracy"]) {
        const bool erratum = row["reason"] != "";
        errata += erratum ? 1 : 0;
        EXPECT_EQ(std::abs(row["difference"].get<double>()) > 1e-3, erratum) << row;
    }
    EXPECT_EQ(errata, 3U);
    EXPECT_THAT(run("--table").out, HasSubstr("Paper 004, Table 4"));
}

TEST(LayoutVerb, suggests_a_name_and_exits_2)
{
    const auto result = run("cone5");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.error, HasSubstr("did you mean 'cone-5'?"));
}

TEST(LayoutVerb, refuses_bad_usage)
{
    EXPECT_THAT(run("cone-4 --without 4").error, HasSubstr("cone-4 has axes 0..3"));
    EXPECT_THAT(run("--without 1").error, HasSubstr("needs a layout"));
    for (const char* arguments :
         {"cone-4 --without 4", "--without 1", "cone-4 --without -1", "cone-4 --without x", "cone-4 --table", "--nonsense"})
        EXPECT_EQ(run(arguments).exit_code, 2) << arguments;
}

TEST_F(AxesFile, is_used_exactly_as_given)
{
    const auto path = written("# four axes\nx, y, z\n1 0 0\n0 1 0\n0 0 1\n0.57735,0.57735,0.57735\n");
    const auto result = run("--axes " + path + " --json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.object()["axes"][3][0], 0.57735);
    EXPECT_EQ(result.object()["name"], path);
    EXPECT_THAT(result.out, HasSubstr("0.57735000000000003"));
}

TEST_F(AxesFile, with_a_norm_off_by_more_than_the_tolerance_is_refused_at_its_line)
{
    const auto path = written("1 0 0\n0 1 0\n0 0 1.001\n");
    const auto result = run("--axes " + path);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr(path + ":3:1: norm 1.001"));
}

TEST_F(AxesFile, that_spans_no_space_is_refused)
{
    EXPECT_THAT(run("--axes " + written("1 0 0\n0 1 0\n0.6 0.8 0\n1 0 0\n")).error, HasSubstr("in one plane"));
    EXPECT_THAT(run("--axes " + written("1 0 0\n0 1 0\n")).error, HasSubstr("at least 3"));
    EXPECT_THAT(run("--axes " + written("")).error, HasSubstr("0 axes given"));
}

TEST_F(AxesFile, with_duplicated_axes_is_legal_and_detects_nothing_elsewhere)
{
    const auto object = run("--axes " + written("1 0 0\n0 1 0\n0 0 1\n0 0 1\n") + " --json").object();
    EXPECT_EQ(object["detectable"], 0);
    EXPECT_TRUE(object["parity_per_axis"][0][0].is_null());
    EXPECT_EQ(object["parity_per_axis"][3][3], 1);
    EXPECT_EQ(object["minimum_angle_deg"], 0);
}

TEST_F(AxesFile, of_25_axes_is_refused_and_of_24_is_not)
{
    std::string text;
    for (int triad = 0; triad < 8; ++triad) text += "1 0 0\n0 1 0\n0 0 1\n";
    EXPECT_EQ(run("--axes " + written(text) + " --json").object()["detectable"], 7);
    EXPECT_THAT(run("--axes " + written(text + "1 0 0\n")).error, HasSubstr(":25:1: at most 24 axes"));
}

TEST_F(AxesFile, with_bad_cells_is_refused_at_file_line_column)
{
    EXPECT_THAT(run("--axes " + written("1 0 0\n0 nan 0\n0 0 1\n")).error, HasSubstr(":2:3: 'nan' is not allowed here"));
    EXPECT_THAT(run("--axes " + written("1 0 0\n0 1\n0 0 1\n")).error, HasSubstr(":2:4: 3 numbers needed"));
    EXPECT_THAT(run("--axes /nowhere.csv").error, HasSubstr("/nowhere.csv: cannot be opened"));
}

}  // namespace
}  // namespace quorient::cli
