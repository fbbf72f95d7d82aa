#include "clusters.hpp"
#include "quorient/simulation/faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

namespace quorient::simulation {
namespace {

using testing::HasSubstr;

TEST(FaultText, reads_the_fault_of_the_demo)
{
    const auto fault = parse_fault("axis=1,kind=scale,value=0.8,start=8,end=18");
    ASSERT_TRUE(fault) << fault.error();
    EXPECT_EQ(fault->axes, 0b10U);
    EXPECT_EQ(fault->kind, FaultKind::scale);
    EXPECT_EQ(fault->value, 0.8);
    EXPECT_EQ(fault->start_s, 8.0);
    EXPECT_EQ(fault->end_s, 18.0);
}

TEST(FaultText, takes_names_of_axes_from_whoever_knows_them)
{
    std::vector<std::string> asked;
    const AxisNames names = [&](std::string_view text) -> tl::expected<AxisMask, std::string> {
        asked.emplace_back(text);
        if (text == "G2+3") return AxisMask{0b1010};
        return tl::make_unexpected("no axis of this name");
    };
    const auto fault = parse_fault("kind=scale,axis=G2+3,value=0.8", names);
    ASSERT_TRUE(fault) << fault.error();
    EXPECT_EQ(fault->axes, 0b1010U);
    EXPECT_EQ(fault->value, 0.8);
    EXPECT_EQ(parse_fault("axis=G9,kind=zero", names).error(), "fault 'axis=G9,kind=zero': no axis of this name");
    EXPECT_EQ(asked, (std::vector<std::string>{"G2+3", "G9"}));
    EXPECT_THAT(parse_fault("axis=G2,kind=zero").error(), HasSubstr("0-based")) << "nobody knows names";
}

TEST(FaultText, asks_for_no_name_where_axes_are_numbers_or_anything_else_is_wrong)
{
    const AxisNames nobody = [](std::string_view text) -> tl::expected<AxisMask, std::string> {
        ADD_FAILURE() << text;
        return AxisMask{1};
    };
    EXPECT_EQ(parse_fault("axis=0+3,kind=stuck", nobody)->axes, 0b1001U);
    EXPECT_THAT(parse_fault("axis=G2,kind=tired", nobody).error(), HasSubstr("unknown kind 'tired'"));
    EXPECT_THAT(parse_fault("axis=G2,kind=zero,start=-1", nobody).error(), HasSubstr("start must be 0 s or later"));
    EXPECT_THAT(parse_fault("axis=24,kind=zero", nobody).error(), HasSubstr("'24'"));
    EXPECT_THAT(parse_fault("axis=-1,kind=zero", nobody).error(), HasSubstr("'-1'"));
    EXPECT_THAT(parse_fault("axis=,kind=zero", nobody).error(), HasSubstr("0-based"));
}

TEST(FaultText, lasts_for_ever_from_the_beginning_unless_told_otherwise)
{
    const auto fault = parse_fault("axis=0+3,kind=stuck");
    ASSERT_TRUE(fault) << fault.error();
    EXPECT_EQ(fault->axes, 0b1001U);
    EXPECT_EQ(fault->start_s, 0.0);
    EXPECT_EQ(fault->end_s, std::numeric_limits<double>::infinity());
}

TEST(FaultText, writes_what_it_reads)
{
    for (const char* const text :
         {"axis=1,kind=bias,value=0.01,start=2,end=3", "axis=0+5,kind=ramp,value=-0.001,start=0",
          "instrument=IMU3,kind=scale,value=0.8,start=14", "axis=1,kind=stuck,start=1", "axis=1,kind=zero,start=1",
          "axis=1,kind=rail,start=1", "axis=1,kind=sign,start=1", "axis=1,kind=nan,start=1", "axis=1,kind=noise,value=10,start=1",
          "axis=1,kind=oscillation,value=0.1,frequency=3,start=1", "axis=1,kind=dropout,value=0.5,start=1",
          "axis=1,kind=delay,value=0.02,start=1", "axis=1,kind=spike,value=2,period=0.5,start=1"}) {
        const auto fault = parse_fault(text);
        ASSERT_TRUE(fault) << fault.error();
        EXPECT_EQ(to_string(*fault), text);
    }
}

TEST(FaultText, says_which_word_is_wrong_and_what_is_right)
{
    const auto error = [](std::string_view text) { return parse_fault(text).error(); };
    EXPECT_THAT(error("axis=1,kind=scal,value=2"), AllOf(HasSubstr("'scal'"), HasSubstr("bias, ramp, scale, stuck")));
    EXPECT_THAT(error("axs=1,kind=zero"), AllOf(HasSubstr("'axs=1'"), HasSubstr("axis=, instrument=, kind=")));
    EXPECT_THAT(error("axis=1,kind"), HasSubstr("'kind'"));
    EXPECT_THAT(error(""), HasSubstr("valid keys"));
    EXPECT_THAT(error("axis=1,kind=zero,"), HasSubstr("unknown word ''"));
    EXPECT_THAT(error("axis=24,kind=zero"), HasSubstr("'24'"));
    EXPECT_THAT(error("axis=-1,kind=zero"), HasSubstr("'-1'"));
    EXPECT_THAT(error("axis=,kind=zero"), HasSubstr("0-based"));
    EXPECT_THAT(error("axis=1,axis=2,kind=zero"), HasSubstr("'axis' stands twice"));
    EXPECT_THAT(error("axis=1,kind=bias,value=0.1rad"), AllOf(HasSubstr("value"), HasSubstr("'0.1rad'")));
    EXPECT_THAT(error("axis=1,kind=bias,value=nan"), HasSubstr("'nan'"));
    EXPECT_THAT(error("axis=1,kind=bias,value=inf"), HasSubstr("finite"));
}

TEST(FaultText, wants_each_kind_complete_and_no_more)
{
    const auto error = [](std::string_view text) { return parse_fault(text).error(); };
    EXPECT_THAT(error("kind=zero"), HasSubstr("axis= or instrument="));
    EXPECT_THAT(error("axis=1,instrument=IMU1,kind=zero"), HasSubstr("either axis= or instrument="));
    EXPECT_THAT(error("axis=1"), HasSubstr("kind is missing"));
    EXPECT_THAT(error("axis=1,kind=bias"), HasSubstr("rad/s"));
    EXPECT_THAT(error("axis=1,kind=zero,value=1"), HasSubstr("no value"));
    EXPECT_THAT(error("axis=1,kind=oscillation,value=1"), HasSubstr("frequency="));
    EXPECT_THAT(error("axis=1,kind=spike,value=1"), HasSubstr("period="));
    EXPECT_THAT(error("axis=1,kind=bias,value=1,period=1"), HasSubstr("period="));
    EXPECT_THAT(error("axis=1,kind=zero,start=5,end=4"), HasSubstr("after start"));
    EXPECT_THAT(error("axis=1,kind=zero,start=-1"), HasSubstr("start"));
    EXPECT_THAT(error("axis=1,kind=dropout,value=1.5"), HasSubstr("(0, 1]"));
    EXPECT_THAT(error("axis=1,kind=delay,value=0"), HasSubstr("above 0"));
}

TEST(FaultText, never_breaks_on_damaged_text)
{
    const std::string good = "axis=1,kind=oscillation,value=0.1,frequency=3,start=1,end=2";
    const unsigned seed = 20240611;
    std::mt19937 random(seed);
    for (int trial = 0; trial < 20000; ++trial) {
        std::string text = good;
        for (int damage = 0; damage < 3; ++damage) text[random() % text.size()] = static_cast<char>(random() % 256);
        const auto fault = parse_fault(text);
        if (fault) {
            EXPECT_TRUE(parse_fault(to_string(*fault))) << text << " seed " << seed;
        }
    }
}

TEST(FaultText, finds_an_instrument_by_name_or_number)
{
    const auto cluster = two_triads();
    EXPECT_EQ(resolve(*parse_fault("instrument=IMU2,kind=zero"), cluster)->axes, 0b111000U);
    EXPECT_EQ(resolve(*parse_fault("instrument=0,kind=zero"), cluster)->axes, 0b000111U);
    EXPECT_THAT(resolve(*parse_fault("instrument=IMU9,kind=zero"), cluster).error(), AllOf(HasSubstr("IMU9"), HasSubstr("IMU1, IMU2")));
}

TEST(FaultText, refuses_what_the_cluster_does_not_have)
{
    auto cluster = two_triads();
    cluster.range.setZero();
    cluster.sigma.setZero();
    EXPECT_THAT(resolve(*parse_fault("axis=6,kind=zero"), cluster).error(), HasSubstr("0 … 5"));
    EXPECT_THAT(resolve(*parse_fault("axis=1,kind=rail"), cluster).error(), HasSubstr("no stated range"));
    EXPECT_THAT(resolve(*parse_fault("axis=1,kind=noise,value=10"), cluster).error(), HasSubstr("no stated sigma"));
    EXPECT_THAT(resolve(*parse_fault("axis=1,kind=delay,value=100"), cluster).error(), HasSubstr("intervals"));
    EXPECT_TRUE(resolve(*parse_fault("axis=1,kind=rail"), two_triads()));
    EXPECT_TRUE(resolve(*parse_fault("axis=1,kind=noise,value=10"), two_triads()));
    EXPECT_TRUE(resolve(*parse_fault("axis=5,kind=delay,value=1"), two_triads()));
}

TEST(FaultText, travels_as_a_command_with_times_from_now)
{
    const auto fault = *parse_fault("axis=1+2,kind=spike,value=2,period=0.5,start=1,end=4");
    const FaultSpec arrived = from_command(to_command(fault), 100.0);
    EXPECT_EQ(to_string(arrived), "axis=1+2,kind=spike,value=2,period=0.5,start=101,end=104");
}

}  // namespace
}  // namespace quorient::simulation
