#include "run_verb.hpp"
#include "verbs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace quorient::cli {
namespace {

using nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* two_faults = "-393.04,1075.35,-612.73,-593.11,1254.79,-761.19\n";  // paper 000's example, misprints corrected

struct Printed : cli::Output {
    std::vector<ordered_json> rows() const
    {
        std::vector<ordered_json> rows;
        std::istringstream lines(out);
        for (std::string line; std::getline(lines, line);) rows.push_back(ordered_json::parse(line));
        return rows;
    }
};

class AssessVerb : public testing::Test {
protected:
    /// Runs the verb on these rows.
    Printed run(const std::string& arguments, const std::string& rows)
    {
        std::ofstream(path_) << rows;
        Program program{"quorient", ""};
        add_assess(program);
    return Printed{run_program(program, "assess " + arguments + " " + path_.string())};
    }
    ~AssessVerb() override { std::filesystem::remove(path_); }

private:
    const testing::TestInfo* test_ = testing::UnitTest::GetInstance()->current_test_info();
    std::filesystem::path path_ = std::filesystem::path(testing::TempDir()) / (std::string("assess_") + test_->name() + ".csv");
};

std::vector<std::string> keys_of(const ordered_json& row)
{
    std::vector<std::string> keys;
    for (const auto& [key, value] : row.items()) keys.push_back(key);
    return keys;
}

TEST_F(AssessVerb, has_the_fields_of_the_contract_in_order)
{
    const std::vector<std::pair<std::string, std::vector<std::string>>> expected{
        {"guaranteed --bound 1 --threshold 10 --direction 0,0,1",
         {"feasible_sets", "empty", "interval", "estimate", "half_width", "decision", "direction_interval"}},
        {"invariants --tolerance 3", {"values", "passed_count", "passed"}},
        {"voting --tolerance 3", {"passed_count"}},
        {"mean --tolerance 3 --max-faults 2", {}},
        {"glt --sigma 1 --pfa 1e-3", {"per_axis", "bias_estimate", "parity"}},
        {"parity-set --sigma 1 --pfa 1e-3", {"parity"}},
        {"subset --sigma 1 --pfa 1e-3 --max-faults 2 --margin 0", {"scores"}}};
    for (const auto& [arguments, further] : expected) {
        std::vector<std::string> keys{"row", "outcome", "isolated", "candidates", "statistic", "threshold", "residual"};
        keys.insert(keys.end(), further.begin(), further.end());
        const auto rows = run("--layout guaranteed-cone --method " + arguments, two_faults).rows();
        ASSERT_EQ(rows.size(), 1U) << arguments;
        EXPECT_EQ(keys_of(rows[0]), keys) << arguments;
        EXPECT_EQ(rows[0]["residual"].size(), 6U);
    }
}

TEST_F(AssessVerb, names_both_faults_of_the_papers_example)
{
    const auto row = run("--layout guaranteed-cone --method guaranteed --bound 1 --threshold 10", two_faults).rows().at(0);
    EXPECT_EQ(row["outcome"], "isolated");
    EXPECT_THAT(row["isolated"].get<std::vector<int>>(), ElementsAre(1, 2));
    EXPECT_EQ(row["feasible_sets"], ordered_json::parse("[[1,2]]"));
    EXPECT_EQ(row["decision"], ordered_json::parse(R"(["H","F","F","H","H","H"])"));
    EXPECT_NEAR(row["interval"][1][1], 1057.195, 1e-9);
    EXPECT_NEAR(row["half_width"][2], 2.7375, 1e-9);
}

TEST_F(AssessVerb, prints_null_where_nothing_is_estimated)
{
    const auto row = run("--layout guaranteed-cone --method guaranteed --bound 1 --threshold 10", "0 0 500 0 900 -700\n").rows().at(0);
    EXPECT_EQ(row["outcome"], "blind");
    EXPECT_EQ(row["empty"], true);
    EXPECT_TRUE(row["interval"][0][0].is_null());
    EXPECT_TRUE(row["residual"][5].is_null());
}

TEST_F(AssessVerb, numbers_rows_from_0_and_judges_each)
{
    const auto rows = run("--layout dodecahedron --method glt --sigma 1 --pfa 1e-3", "# comment\n0,0,0,0,0,0\n\n0,0,50,0,0,0\n").rows();
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0]["row"], 0);
    EXPECT_EQ(rows[0]["outcome"], "healthy");
    EXPECT_EQ(rows[1]["row"], 1);
    EXPECT_EQ(rows[1]["isolated"], ordered_json::parse("[2]"));
    EXPECT_NEAR(rows[1]["bias_estimate"], 50, 1e-9);
}

TEST_F(AssessVerb, keeps_the_history_of_temporal_methods_from_row_to_row)
{
    const std::string calm = "1 1 1 1\n";
    const auto rows = run("--layout cone-4 --method vector --tolerance 0.5", calm + calm + calm + calm + calm + "1 9 1 1\n").rows();
    ASSERT_EQ(rows.size(), 6U);
    EXPECT_EQ(rows[3]["outcome"], "warming_up");
    EXPECT_EQ(rows[4]["outcome"], "healthy");
    EXPECT_EQ(rows[5]["isolated"], ordered_json::parse("[1]"));
    EXPECT_EQ(rows[5]["working_triad"], ordered_json::parse("[0,2,3]"));

    const auto modulus = run("--layout cone-4 --method extrapolation --tolerance 0.5", calm).rows().at(0);
    EXPECT_EQ(modulus["triad_modulus"].size(), 4U);
    EXPECT_TRUE(modulus["predicted"].is_null());
}

TEST_F(AssessVerb, exits_1_where_an_outcome_is_not_the_one_to_check)
{
    const std::string arguments = "--layout dodecahedron --method glt --sigma 1 --check healthy";
    EXPECT_EQ(run(arguments, "0,0,0,0,0,0\n").exit_code, 0);
    EXPECT_EQ(run(arguments, "0,0,0,0,0,0\n0,0,50,0,0,0\n").exit_code, 1);
}

TEST_F(AssessVerb, explains_bad_usage_and_exits_2)
{
    const auto explanation = [this](const std::string& arguments, const std::string& rows = "0,0,0,0,0,0\n") {
        const Printed result = run(arguments, rows);
        EXPECT_EQ(result.exit_code, 2) << arguments;
        return result.error;
    };
    EXPECT_THAT(explanation("--layout cone-6 --method mean --bound 1"), HasSubstr("--bound means nothing to method mean"));
    EXPECT_THAT(explanation("--method mean --tolerance 1"), HasSubstr("--layout"));
    EXPECT_THAT(explanation("--layout cone-6 --method glt --sigma -1"), HasSubstr("--sigma: must be above 0, got -1"));
    EXPECT_THAT(explanation("--layout cone-6 --method glt --sigma nan"), HasSubstr("--sigma: must be finite, got nan"));
    EXPECT_THAT(explanation("--layout cone-5 --method voting --tolerance 1"), HasSubstr("at least 6 axes"));
    EXPECT_THAT(explanation("--layout cone-6 --method mean --tolerance 1", "1,2,3\n"), HasSubstr(":1:"));
    EXPECT_THAT(explanation("--layout cone-6 --method mean --tolerance 1", "1,2,3,inf,5,6\n"), HasSubstr("'inf' is not allowed"));
    explanation("--layout cone-6 --method majority");
    explanation("--layout cone-6 --method guaranteed --bound 1 --direction 1,2");
}

}  // namespace
}  // namespace quorient::cli
