#include "cli/csv_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <sstream>

namespace quorient::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Outcome {
    std::vector<std::vector<double>> rows;
    std::vector<std::size_t> lines;
    std::vector<std::string> header;
    std::string error;
};

Outcome read(const std::string& text, CsvOptions options = {})
{
    std::istringstream input(text);
    CsvReader reader(input, "in.csv", options);
    Outcome outcome;
    for (CsvRow row;;) {
        const auto more = reader.next(row);
        if (!more) outcome.error = more.error();
        if (!more || !*more) break;
        outcome.rows.push_back(row.value);
        outcome.lines.push_back(row.line);
    }
    outcome.header = reader.header();
    return outcome;
}

TEST(Csv, takes_commas_and_white_space_alike)
{
    const auto outcome = read("1,2,3\n4 5\t6\n 7 , 8,9 \r\n");
    EXPECT_EQ(outcome.error, "");
    EXPECT_THAT(outcome.rows, ElementsAre(ElementsAre(1, 2, 3), ElementsAre(4, 5, 6), ElementsAre(7, 8, 9)));
}

TEST(Csv, skips_comments_and_blank_lines_and_keeps_line_numbers)
{
    const auto outcome = read("\xEF\xBB\xBF# axes\n\n1 2 # first\n   \n3 4");
    EXPECT_EQ(outcome.error, "");
    EXPECT_THAT(outcome.rows, ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4)));
    EXPECT_THAT(outcome.lines, ElementsAre(3, 5));
}

TEST(Csv, takes_a_first_row_without_numbers_as_header)
{
    const auto outcome = read("# comment\ntime, x\n0,1\n");
    EXPECT_THAT(outcome.header, ElementsAre("time", "x"));
    EXPECT_THAT(outcome.rows, ElementsAre(ElementsAre(0, 1)));
    EXPECT_THAT(read("0,1\n").header, testing::IsEmpty());
}

TEST(Csv, takes_no_bad_row_of_numbers_for_a_header)
{
    EXPECT_EQ(read("1;2;3\n").error, "in.csv:1:1: '1;2;3' is not a number");
    EXPECT_EQ(read("0.1x -.2y\n").error, "in.csv:1:1: '0.1x' is not a number");
    EXPECT_EQ(read("gyro_x,2nd\n1,2\n").error, "in.csv:1:1: 'gyro_x' is not a number") << "a header has words only";
}

TEST(Csv, says_what_there_was_in_place_of_rows)
{
    const auto nothing_in = [](const std::string& text) {
        std::istringstream input(text);
        CsvReader reader(input, "in.csv", {.columns = 3});
        CsvRow row;
        EXPECT_EQ(reader.next(row), (tl::expected<bool, std::string>(false)));
        return reader.nothing();
    };
    EXPECT_EQ(nothing_in(""), "in.csv: expected a row of 3 numbers, there is nothing at all");
    EXPECT_EQ(nothing_in("# a\n\n"), "in.csv: expected a row of 3 numbers, there is only comments and blank lines (2)");
    EXPECT_EQ(nothing_in("x,y,z\n"), "in.csv: expected a row of 3 numbers, there is only a header of 3 names");
}

TEST(Csv, takes_only_the_first_row_as_header)
{
    EXPECT_EQ(read("a,b\nc,d\n").error, "in.csv:2:1: 'c' is not a number");
}

TEST(Csv, reads_every_way_to_write_a_number)
{
    EXPECT_THAT(read("+1 -2e-3 .5 6E+2 -0\n").rows, ElementsAre(ElementsAre(1, -2e-3, .5, 600, 0)));
}

TEST(Csv, names_line_and_column_of_a_bad_cell)
{
    EXPECT_EQ(read("1,2\n3, four\n").error, "in.csv:2:4: 'four' is not a number");
    EXPECT_EQ(read("1,x\n").error, "in.csv:1:3: 'x' is not a number");
    EXPECT_EQ(read("1,2\n3,1.2.3\n").error, "in.csv:2:3: '1.2.3' is not a number");
    EXPECT_EQ(read("1e999\n").error, "in.csv:1:1: '1e999' does not fit a double");
}

TEST(Csv, refuses_missing_values)
{
    EXPECT_THAT(read("1,,3\n").error, HasSubstr("in.csv:1:3: a value is missing"));
    EXPECT_THAT(read(",1\n").error, HasSubstr("in.csv:1:1: a value is missing"));
    EXPECT_THAT(read("1,2,\n").error, HasSubstr("in.csv:1:5: a value is missing"));
}

TEST(Csv, refuses_rows_of_another_length)
{
    EXPECT_EQ(read("1,2,3\n4,5\n").error, "in.csv:2:4: 3 numbers needed in every row, got 2");
    EXPECT_EQ(read("1,2\n4,5,6\n").error, "in.csv:2:5: 2 numbers needed in every row, got 3");
    EXPECT_EQ(read("1,2\n", {.columns = 3}).error, "in.csv:1:4: 3 numbers needed in every row, got 2");
    EXPECT_EQ(read("1,2,3\n", {.columns = 3}).error, "");
}

TEST(Csv, takes_nan_and_inf_only_where_the_caller_says_so)
{
    EXPECT_THAT(read("1,nan\n").error, HasSubstr("in.csv:1:3: 'nan' is not allowed here"));
    EXPECT_THAT(read("-inf\n").error, HasSubstr("'-inf' is not allowed here"));
    const auto outcome = read("nan,-inf\n", {.allow_non_finite = true});
    ASSERT_EQ(outcome.rows.size(), 1U);
    EXPECT_TRUE(std::isnan(outcome.rows[0][0]));
    EXPECT_EQ(outcome.rows[0][1], -INFINITY);
}

TEST(Csv, of_nothing_has_no_rows)
{
    EXPECT_THAT(read("").rows, testing::IsEmpty());
    EXPECT_EQ(read("# only a comment\n").error, "");
}

TEST(Csv, says_which_file_cannot_be_read)
{
    EXPECT_THAT(read_csv("/nowhere/axes.csv").error(), HasSubstr("/nowhere/axes.csv: cannot be opened"));
    EXPECT_THAT(read_csv("/").error(), HasSubstr("/: cannot be"));
}

}  // namespace
}  // namespace quorient::cli
