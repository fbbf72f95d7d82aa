#include "run_verb.hpp"
#include "verbs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace quorient::cli {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

using Run = Output;

// Runs the verb on a file with these rows.
Run run(const std::string& options, const std::string& rows)
{
    const auto path = std::filesystem::path(testing::TempDir()) /
                      (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_rows.csv");
    std::ofstream(path) << rows;
    Program program{"quorient", ""};
    add_propagate(program);
    const auto output = run_program(program, "propagate " + options + " " + path.string());
    std::filesystem::remove(path);
    return Run{output};
}

std::vector<double> last_row(const std::string& csv)
{
    std::istringstream lines(csv);
    std::string last;
    for (std::string line; std::getline(lines, line);) last = line;
    std::vector<double> cells;
    std::istringstream stream(last);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(std::stod(cell));
    return cells;
}

TEST(PropagateVerb, prints_the_attitude_at_the_end_of_every_row)
{
    const auto result = run("--algorithm window-10 --interval 0.01", "0,0,0.78539816339744831\n0 0 0.78539816339744831 # the same again\n");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, StartsWith("row,q_w,q_x,q_y,q_z\n0,"));
    const auto last = last_row(result.out);
    ASSERT_EQ(last.size(), 5u);
    EXPECT_EQ(last[0], 1);
    EXPECT_NEAR(last[1], std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(last[4], std::sqrt(0.5), 1e-15);
}

TEST(PropagateVerb, starts_from_the_attitude_given)
{
    const auto result = run("--interval 1 --initial 0,1,0,0 --algorithm single", "3.14159265358979312,0,0\n");
    EXPECT_NEAR(std::abs(last_row(result.out)[1]), 1, 1e-15) << result.out;
    EXPECT_EQ(run("--interval 1 --initial 2,0,0,0", "0,0,0\n").exit_code, 2);
}

TEST(PropagateVerb, prints_json_and_the_list_of_algorithms)
{
    const auto object = nlohmann::json::parse(run("--interval 1 --json", "0,0,0\n").out);
    EXPECT_EQ(object["row"], 0);
    EXPECT_EQ(object["attitude"], (std::vector<double>{1, 0, 0, 0}));
    EXPECT_THAT(run("--list", "").out, HasSubstr("three-sample-miller"));
}

TEST(PropagateVerb, refuses_bad_input_with_place_and_reason)
{
    const auto bad_cell = run("--interval 1", "0,0,0\n0,zero,0\n");
    EXPECT_EQ(bad_cell.exit_code, 2);
    EXPECT_THAT(bad_cell.error, HasSubstr("rows.csv:2:3:"));
    const auto two_cells = run("--interval 1", "0,0\n");
    EXPECT_EQ(two_cells.exit_code, 2);
    EXPECT_THAT(two_cells.error, HasSubstr("3 numbers needed"));
    const auto degrees = run("--interval 1", "0,0,1e7\n");
    EXPECT_EQ(degrees.exit_code, 2);
    EXPECT_THAT(degrees.error, HasSubstr("rows.csv:1:"));
    const auto unknown = run("--interval 1 --algorithm window-99", "0,0,0\n");
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_THAT(unknown.error, HasSubstr("window-N"));
    EXPECT_THAT(run("", "0,0,0\n").error, HasSubstr("--interval"));
    EXPECT_EQ(run("--interval 0", "0,0,0\n").exit_code, 2);
}

}  // namespace
}  // namespace quorient::cli
