#include "cli/json_output.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>

namespace quorient::cli {
namespace {

TEST(JsonOutput, has_seventeen_significant_digits)
{
    EXPECT_EQ(dump({{"tenth", 0.1}, {"half", 0.5}, {"three_tenths", 0.3}}),
              R"({"tenth":0.10000000000000001,"half":0.5,"three_tenths":0.29999999999999999})");
}

TEST(JsonOutput, reads_back_to_the_same_bits)
{
    for (const double value : {1.0 / 3, 6.02214076e23, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()})
        EXPECT_EQ(Json::parse(dump(value)).get<double>(), value);
}

TEST(JsonOutput, writes_whole_numbers_that_doubles_cannot_hold_as_strings)
{
    EXPECT_EQ(dump({{"last", 9007199254740992U}, {"first", 9007199254740993U}, {"most", 18446744073709551615U}}),
              R"({"last":9007199254740992,"first":"9007199254740993","most":"18446744073709551615"})");
    EXPECT_EQ(dump({-9007199254740992, -9007199254740993}), R"([-9007199254740992,"-9007199254740993"])");
}

TEST(JsonOutput, writes_null_for_what_is_not_finite)
{
    EXPECT_EQ(dump({{"a", std::nan("")}, {"b", {1.0, INFINITY}}, {"c", nullptr}}), R"({"a":null,"b":[1,null],"c":null})");
}

TEST(JsonOutput, keeps_order_and_escapes_text)
{
    EXPECT_EQ(dump({{"z", "say \"hi\""}, {"a", true}, {"n", 3}, {"empty", Json::array()}, {"none", Json::object()}}),
              R"({"z":"say \"hi\"","a":true,"n":3,"empty":[],"none":{}})");
}

TEST(JsonOutput, replaces_what_is_no_utf_8)
{
    EXPECT_EQ(dump({{"Kr\xfc", "1 \xb0/s"}, {"\u00fc", "\u00b0"}}), "{\"Kr\uFFFD\":\"1 \uFFFD/s\",\"\u00fc\":\"\u00b0\"}");
}

TEST(JsonOutput, writes_matrices_by_rows_and_masks_by_axes)
{
    Eigen::Matrix<double, 2, 3> matrix;
    matrix << 1, 2, 3, 4, 5, 6;
    EXPECT_EQ(dump(matrix_json(matrix)), "[[1,2,3],[4,5,6]]");
    EXPECT_EQ(dump(vector_json(matrix.row(1))), "[4,5,6]");
    EXPECT_EQ(dump(matrix_json(Eigen::MatrixXd(0, 3))), "[]");
    EXPECT_EQ(dump(axes_json(0b10010)), "[1,4]");
}

}  // namespace
}  // namespace quorient::cli
