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

using nlohmann::json;
using testing::HasSubstr;

Output run(const std::string& arguments)
{
    Program program{"quorient", ""};
    add_vessel(program);
    return run_program(program, "vessel " + arguments);
}

std::vector<json> rows(const std::string& arguments)
{
    const Output output = run(arguments + " --json");
    EXPECT_EQ(output.exit_code, 0) << output.error;
    std::vector<json> all;
    std::istringstream text(output.out);
    for (std::string line; std::getline(text, line);) all.push_back(json::parse(line));
    return all;
}

class File {
public:
    explicit File(const std::string& text) : path_(std::filesystem::path(testing::TempDir()) / "vessel_test.yaml")
    {
        std::ofstream(path_) << text;
    }
    ~File() { std::filesystem::remove(path_); }
    std::string name() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

TEST(VesselVerb, prints_the_gains_of_both_schemes)
{
    const json gains = json::parse(run("--gains").out);
    EXPECT_NEAR(gains["A"][1][0].get<double>(), 2.1463414634146343, 1e-14);
    ASSERT_EQ(gains["observers"].size(), 4U);
    EXPECT_NEAR(gains["observers"][0]["K"][0][1].get<double>(), 2.88248337, 1e-8);
    EXPECT_NEAR(gains["observers"][1]["K"][1][0].get<double>(), 3.28947368, 1e-8);
    EXPECT_NEAR(gains["observers"][2]["K"][0][1].get<double>(), 4.90521064, 1e-8);
    EXPECT_NEAR(gains["observers"][3]["K"][1][0].get<double>(), 2.27150193, 1e-8);
    EXPECT_EQ(gains["observers"][3]["scheme"], "blind");
}

TEST(VesselVerb, isolates_the_papers_two_faults)
{
    for (const std::string scheme : {"blind", "directional"}) {
        int gyro = 0, sway = 0;
        for (const json& row : rows("--scheme " + scheme)) {
            const double time = row["time"];
            gyro += time >= 26 && time < 30 && row["isolated"] == json::array({1}) ? 1 : 0;
            sway += time >= 60 && time < 70 && row["isolated"] == json::array({0}) ? 1 : 0;
            if (time >= 5 && time < 20) {
                EXPECT_EQ(row["decision"], "healthy") << time;
            }
        }
        EXPECT_EQ(gyro, 400) << scheme;
        EXPECT_EQ(sway, 1000) << scheme;
    }
}

TEST(VesselVerb, decides_nothing_where_there_is_no_fault)
{
    for (const json& row : rows("--fault none --noise 1e-4")) EXPECT_EQ(row["decision"], "healthy") << row["time"];
}

TEST(VesselVerb, takes_any_fault)
{
    int isolated = 0;
    for (const json& row : rows("--duration 10 --fault axis=0,kind=ramp,value=0.01,start=2"))
        isolated += row["isolated"] == json::array({0}) ? 1 : 0;
    EXPECT_GT(isolated, 700);
}

TEST(VesselVerb, prints_csv_with_a_header)
{
    const Output output = run("--duration 0.02");
    EXPECT_EQ(output.out.substr(0, output.out.find('\n')),
              "time,rudder,state_0,state_1,residual_0_0,residual_0_1,residual_1_0,residual_1_1,metric_0,metric_1,decision,channels");
    EXPECT_EQ(std::count(output.out.begin(), output.out.end(), '\n'), 4);
}

TEST(VesselVerb, prints_the_run_beside_the_recomputed_figures)
{
    const Output output = run("--table");
    EXPECT_EQ(output.exit_code, 0) << output.error;
    EXPECT_THAT(output.out, HasSubstr("K_a 1 2      2.88248337    2.88248337"));
    EXPECT_THAT(output.out, testing::Not(HasSubstr("exceeded")));
    int compared = 0;
    std::istringstream text(output.out);
    for (std::string line; std::getline(text, line);) {
        if (line.size() < 2 || line.substr(line.size() - 2) != " %") continue;
        const auto sign = line.find_last_of("+-");
        if (sign == std::string::npos) continue;  // a share, not a difference
        ++compared;
        const bool one_digit = line.find("8.0e-06") != std::string::npos || line.find("1.1e-05") != std::string::npos ||
                               line.find("4.0e-06") != std::string::npos;
        EXPECT_LT(std::abs(std::stod(line.substr(sign))), one_digit ? 12.0 : 2.0) << line;
    }
    EXPECT_EQ(compared, 14);
}

TEST(VesselVerb, prints_the_same_figures_as_json)
{
    const Output output = run("--table --json");
    EXPECT_EQ(output.exit_code, 0) << output.error;
    const auto table = json::parse(output.out);
    ASSERT_EQ(table["gains"].size(), 4U);
    for (const auto& observer : table["gains"])
        for (std::size_t entry = 0; entry < 4; ++entry)
            EXPECT_NEAR(observer["gain"][entry].get<double>(), observer["recomputed"][entry].get<double>(), 1e-7) << observer["name"];
    EXPECT_EQ(table["windows"].size(), 18U);
    EXPECT_EQ(table["named_percent"].size(), 2U);
    EXPECT_EQ(table["false_alarms"]["blind"], 0);
}

TEST(VesselVerb, draws_the_papers_figures)
{
    const auto file = std::filesystem::path(testing::TempDir()) / "vessel_test.svg";
    EXPECT_EQ(run("--scheme directional --plot " + file.string()).exit_code, 0);
    std::ifstream stream(file);
    const std::string svg{std::istreambuf_iterator<char>(stream), {}};
    std::filesystem::remove(file);
    for (const char* figure :
         {"(paper 001, Fig. 4a)", "(Fig. 4b)", "observer of channel 0 (Fig. 5)", "observer of channel 1 (Fig. 5)", "(Fig. 6)"})
        EXPECT_THAT(svg, HasSubstr(figure));
    EXPECT_THAT(svg, HasSubstr("</svg>"));
}

TEST(VesselVerb, takes_a_plant_of_the_users_own)
{
    const File file("plant: {A: [[-1, 0.5], [-0.3, -2]], B: [[0], [1]]}\nblind_poles: [[[-3, 1]]]\nthreshold: 1e-3\n");
    const json gains = json::parse(run("--gains --scheme blind --vessel " + file.name()).out);
    EXPECT_NEAR(std::abs(gains["observers"][1]["poles"][0][1].get<double>()), 1, 1e-9);
}

TEST(VesselVerb, explains_what_is_wrong_with_a_file)
{
    const auto refused = [](const std::string& text) {
        const File file(text);
        const Output output = run("--vessel " + file.name());
        EXPECT_EQ(output.exit_code, 2);
        EXPECT_EQ(output.out, "");
        return output.error;
    };
    EXPECT_THAT(refused("tresholds: 1\n"), HasSubstr("vessel_test.yaml:1:1: unknown key 'tresholds'; did you mean 'threshold'?"));
    EXPECT_THAT(refused("plant: {A: [[1, 2], [3]], B: [[1], [1]]}\n"), HasSubstr("row 1 must have 2 numbers like the first"));
    EXPECT_THAT(refused("plant: {A: [[1, 2], [3, 4]], B: [[1]]}\n"), HasSubstr("B must be 2 x 1, got 1 x 1"));
    EXPECT_THAT(refused("blind_poles: [[-3, 4]]\n"), HasSubstr("not in the left half plane"));
    EXPECT_THAT(refused("blind_poles: -3\n"), HasSubstr("one list of poles per channel"));
    EXPECT_THAT(refused("plant: {A: [[0.5, 0], [0, -2]], B: [[1], [1]]}\n"), HasSubstr("do not see the plant's pole 0.5"));
}

TEST(VesselVerb, explains_bad_usage)
{
    EXPECT_EQ(run("--fault axis=5,kind=bias,value=1").exit_code, 2);
    EXPECT_EQ(run("--interval 0").exit_code, 2);
    EXPECT_NE(run("--scheme luenberger").exit_code, 0);
    EXPECT_EQ(run("--vessel /nowhere.yaml").exit_code, 2);
}

}  // namespace
}  // namespace quorient::cli
