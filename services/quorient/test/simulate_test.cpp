#include "quorient/geometry/layouts.hpp"
#include "quorient/simulation/motion.hpp"
#include "run_verb.hpp"
#include "verbs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

namespace quorient::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;

struct Printed : cli::Output {
    std::vector<std::string> lines() const
    {
        std::vector<std::string> all;
        std::istringstream text(out);
        for (std::string line; std::getline(text, line);) all.push_back(line);
        return all;
    }
};

Printed run(const std::string& arguments)
{
    Program program{"quorient", ""};
    add_simulate(program);
    return Printed{run_program(program, "simulate " + arguments)};
}

std::vector<double> numbers(const std::string& line)
{
    std::vector<double> values;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) values.push_back(std::stod(cell));
    return values;
}

TEST(SimulateVerb, writes_one_row_per_interval_with_the_truth_at_its_end)
{
    const Printed result = run("coning --layout cone-4 --interval 0.1 --duration 2");
    EXPECT_EQ(result.exit_code, 0);
    const auto lines = result.lines();
    ASSERT_EQ(lines.size(), 21U);
    EXPECT_EQ(lines[0], "time,increment_0,increment_1,increment_2,increment_3,truth_w,truth_x,truth_y,truth_z");

    const simulation::Motion motion = simulation::Coning{};
    const auto cluster = *geometry::layout("cone-4");
    const Eigen::Vector4d increment = cluster.axes * motion.increment(0.6, 0.1);
    const Eigen::Quaterniond q = motion.attitude(0.7);
    const auto row = numbers(lines[7]);
    ASSERT_EQ(row.size(), 9U);
    EXPECT_DOUBLE_EQ(row[0], 0.7);
    for (std::size_t axis = 0; axis < 4; ++axis) EXPECT_NEAR(row[1 + axis], increment(static_cast<Eigen::Index>(axis)), 1e-16);
    EXPECT_NEAR(row[5], q.w(), 1e-15);
    EXPECT_NEAR(row[8], q.z(), 1e-15);
}

TEST(SimulateVerb, prints_the_state_at_one_time)
{
    const Printed result = run("coning --at 10 --k2 0.084 --k3 0.05 --interval 0.1 --json");
    const json state = json::parse(result.out);
    EXPECT_NEAR(state["rate"][1].get<double>(), 0.084 * std::cos(0.5), 1e-16);
    const auto body = state["body_increment"];
    EXPECT_NEAR(std::hypot(body[0].get<double>(), body[1].get<double>(), body[2].get<double>()), 0.0097754720, 5e-11)
        << "printed in paper 003";
    EXPECT_EQ(run("coning --at 10").lines().size(), 2U);
}

TEST(SimulateVerb, injects_faults_and_keeps_other_axes_and_times_as_they_are)
{
    const auto healthy = run("coning --interval 0.1 --duration 2").lines();
    const auto faulty = run("coning --interval 0.1 --duration 2 --fault axis=1,kind=scale,value=0.8,start=1,end=1.5").lines();
    ASSERT_EQ(healthy.size(), faulty.size());
    for (std::size_t i = 1; i < healthy.size(); ++i) {
        const auto before = numbers(healthy[i]);
        const auto after = numbers(faulty[i]);
        const bool active = i > 10 && i <= 15;
        for (std::size_t column = 0; column < before.size(); ++column)
            EXPECT_DOUBLE_EQ(after[column], column == 2 && active ? 0.8 * before[column] : before[column])
                << "row " << i << " column " << column;
    }
}

TEST(SimulateVerb, is_the_same_for_the_same_seed_only)
{
    const std::string arguments = "random --duration 0.5 --noise-rad 1e-5 --seed ";
    EXPECT_EQ(run(arguments + "3").out, run(arguments + "3").out);
    EXPECT_NE(run(arguments + "3").out, run(arguments + "4").out);
}

TEST(SimulateVerb, carries_the_remainder_where_a_quantum_is_given)
{
    EXPECT_EQ(run("coning --duration 1 --quantum 1e-6").out, run("coning --duration 1 --quantum 1e-6 --quantize carry").out);
    EXPECT_NE(run("coning --duration 1 --quantum 1e-6").out, run("coning --duration 1 --quantum 1e-6 --quantize truncate").out);
}

TEST(SimulateVerb, explains_bad_usage_with_exit_code_2)
{
    const auto refused = [](const std::string& arguments) {
        const Printed result = run(arguments);
        EXPECT_NE(result.exit_code, 0) << arguments;
        EXPECT_TRUE(result.out.empty()) << arguments;
        return result.error;
    };
    EXPECT_THAT(refused("coning --fault axis=1,kind=scal,value=2"), AllOf(HasSubstr("'scal'"), HasSubstr("scale")));
    EXPECT_THAT(refused("coning --fault axis=4,kind=zero"), HasSubstr("0 … 3"));
    EXPECT_THAT(refused("rest --k2 1"), AllOf(HasSubstr("--k2"), HasSubstr("coning")));
    EXPECT_THAT(refused("coning --mu 1 --nu 1"), HasSubstr("mu^2 + nu^2"));
    EXPECT_THAT(refused("coning --interval -1"), HasSubstr("interval"));
    EXPECT_THAT(refused("coning --duration 0"), HasSubstr("duration"));
    EXPECT_THAT(refused("coning --quantize truncate"), HasSubstr("quantum"));
    EXPECT_THAT(refused("coning --quantum 1e-6 --quantize round"), HasSubstr("body-truncate"));
    EXPECT_THAT(refused("coning --layout con-4"), HasSubstr("cone-4"));
    EXPECT_THAT(refused("tumble"), HasSubstr("classic-coning"));
    EXPECT_THAT(refused("coning --at nan"), HasSubstr("finite"));
    EXPECT_EQ(run("rest --k2 1").exit_code, 2);
}

}  // namespace
}  // namespace quorient::cli
