#include "run_verb.hpp"
#include "verbs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace quorient::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string demo = QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml";

Output check(const std::string& arguments)
{
    Program program{"quorient", ""};
    add_check(program);
    return run_program(program, "check " + arguments);
}

class CheckedFile : public testing::Test {
protected:
    std::string written(const std::string& text, const std::string& name = "system.yaml")
    {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / ("check-" + std::to_string(::getpid()));
};

TEST_F(CheckedFile, that_is_in_order_is_printed_with_every_value_that_holds)
{
    const auto output = check(demo);
    EXPECT_EQ(output.exit_code, 0) << output.error;
    EXPECT_EQ(output.error, "");
    EXPECT_THAT(output.out, HasSubstr("method: extrapolation"));
    EXPECT_THAT(output.out, HasSubstr("level_window: 10"));
    EXPECT_EQ(check(written(output.out)).out, output.out) << "what it prints reads back to the same";
}

TEST_F(CheckedFile, takes_what_the_command_line_sets)
{
    const auto output = check(demo + " --set lanes.a.detector.pfa=1.0e-9 --domain 77 --dds fastdds");
    EXPECT_EQ(output.exit_code, 0) << output.error;
    EXPECT_THAT(output.out, HasSubstr("pfa: 1e-09"));
    EXPECT_THAT(output.out, HasSubstr("domain: 77\ndds: fastdds"));
}

TEST_F(CheckedFile, with_problems_is_refused_with_all_of_them_and_nothing_on_stdout)
{
    const auto output = check(demo + " --set source.rate_hz=0 --set voting.patience=0");
    EXPECT_EQ(output.exit_code, 2);
    EXPECT_EQ(output.out, "");
    EXPECT_THAT(output.error, HasSubstr("--set source.rate_hz=0: source.rate_hz: must be 1 to 20000 [Hz], got 0"));
    EXPECT_THAT(output.error, HasSubstr("2 problems, nothing started"));
}

TEST_F(CheckedFile, is_judged_by_what_its_log_holds)
{
    const std::string lanes = "lanes: [{name: a, detector: {method: vector}}]\nvoters: [{name: v}]\n";
    const auto without = check(written("source: {kind: log, file: no.csv}\n" + lanes));
    EXPECT_EQ(without.exit_code, 2);
    EXPECT_THAT(without.error, HasSubstr("system.yaml:1:27: source.file: "));
    EXPECT_THAT(without.error, HasSubstr("no.csv"));

    Program program{"quorient", ""};
    add_simulate(program);
    std::ofstream(folder_ / "six.csv") << run_program(program, "simulate rest --layout cone-6 --interval 0.01 --duration 1").out;
    const auto unfit =
        check(written("unit: {layout: cone-6}\nsource: {kind: log, file: six.csv, rate_hz: 100, noise_rad: 1.0e-6}\n" + lanes));
    EXPECT_EQ(unfit.exit_code, 2);
    EXPECT_THAT(unfit.error, HasSubstr("lanes[0].detector: "));
    const auto other =
        check(written("unit: {layout: cone-4}\nsource: {kind: log, file: six.csv, rate_hz: 100, noise_rad: 1.0e-6}\n" + lanes));
    EXPECT_THAT(other.error, HasSubstr("has 6 axes, the system file's layout 4"));
}

TEST_F(CheckedFile, may_belong_to_other_hosts)
{
    const std::string compose = QUORIENT_SOURCE_DIR "/deploy/configurations/compose.yaml";
    EXPECT_EQ(check(compose).exit_code, 2) << "its networks are not here";
    EXPECT_EQ(check(compose + " --any-host").exit_code, 0);
    EXPECT_EQ(check(compose + " --process voter-1").exit_code, 0) << "interface: any";
    EXPECT_EQ(check(compose + " --process fdi-c").exit_code, 2);
}

TEST_F(CheckedFile, is_reported_as_json)
{
    const auto good = json::parse(check(demo + " --json").out);
    EXPECT_EQ(good["problems"], json::array());
    EXPECT_EQ(good["configuration"].get<std::string>() + "\n", check(demo).out);
    const auto file = written("unit: {layout: cone-4}\nlanes: [{name: a, detector: {sgima: 1}}]\nvoters: [{}]\nsource: {noise_rad: 1.0e-6}\n");
    const auto output = check(file + " --json --set source.speed=0");
    EXPECT_EQ(output.exit_code, 2);
    const auto bad = json::parse(output.out);
    EXPECT_EQ(bad["configuration"], nullptr);
    ASSERT_EQ(bad["problems"].size(), 2U);
    EXPECT_EQ(bad["problems"][0]["key"], "source.speed");
    EXPECT_EQ(bad["problems"][0]["line"], nullptr);
    EXPECT_EQ(bad["problems"][1]["line"], 2);
    EXPECT_EQ(bad["problems"][1]["column"], 30);
    EXPECT_THAT(bad["problems"][1]["text"].get<std::string>(), HasSubstr("did you mean 'sigma'?"));
}

TEST(Check, explains_keys_and_sections)
{
    const auto patience = check("--key voting.patience");
    EXPECT_EQ(patience.exit_code, 0);
    EXPECT_EQ(
        patience.out,
        "patience: number, above 0 and at most 10 [intervals]; left out: 1\n    How long a frame waits for the votes of all lanes.\n");
    EXPECT_THAT(check("--key voting").out, HasSubstr("\nlisten_s: number"));
    EXPECT_THAT(check("--key all").out, HasSubstr("\nlanes[].integrator\n"));
    EXPECT_EQ(check("--key voting.patients").exit_code, 2);
}

TEST(Check, prints_the_reference_page)
{
    std::ifstream file(QUORIENT_SOURCE_DIR "/docs/system-file.md");
    EXPECT_EQ(check("--reference").out, std::string(std::istreambuf_iterator<char>(file), {}));
}

TEST(Check, needs_something_to_do)
{
    EXPECT_EQ(check("").exit_code, 2);
}

}  // namespace
}  // namespace quorient::cli
