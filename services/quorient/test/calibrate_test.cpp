#include "cli/svg_plot.hpp"
#include "data_folder.hpp"
#include "report/sample_store.hpp"
#include "run_verb.hpp"
#include "verbs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

namespace quorient::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double degree = 3.14159265358979323846 / 180;

std::filesystem::path data_dir()
{
    return recording::data_folder(QUORIENT_SOURCE_DIR);
}

Output run(const std::string& arguments)
{
    Program program{"quorient", ""};
    add_calibrate(program);
    add_simulate(program);
    return run_program(program, arguments);
}

class CalibrateVerb : public testing::Test {
protected:
    CalibrateVerb() { std::filesystem::create_directories(dir_); }
    ~CalibrateVerb() override { std::filesystem::remove_all(dir_); }

    std::string path(const std::string& name) const { return (dir_ / name).string(); }

    static std::string content(const std::string& file)
    {
        std::ostringstream text;
        text << std::ifstream(file).rdbuf();
        return text.str();
    }

private:
    std::filesystem::path dir_ = std::filesystem::temp_directory_path() / ("quorient_calibrate_" + std::to_string(getpid()));
};

/// Three gyros at 100 Hz, 8 s of rest and then motion about all axes: g1 is turned by 90 degrees about z, g2 by 180 about x.
std::string turned_gyros()
{
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0.0, 0.05);
    std::ostringstream text;
    text << "time_s";
    for (int m = 0; m < 3; ++m) text << ",g" << m << "x [deg/s],g" << m << "y [deg/s],g" << m << "z [deg/s]";
    text << '\n';
    for (int k = 0; k < 4000; ++k) {
        const double t = 0.01 * k;
        const double moves = t > 8 ? 1 : 0;
        const double x = moves * 60 * std::sin(1.1 * t);
        const double y = moves * 50 * std::sin(0.7 * t + 1);
        const double z = moves * 70 * std::sin(0.9 * t + 2);
        text << t;
        for (const double rate : {x, y, z, y, -x, z, x, -y, -z}) text << ',' << rate + noise(random);
        text << '\n';
    }
    return text.str();
}

TEST_F(CalibrateVerb, says_how_instruments_are_mounted_in_words_and_as_rotations)
{
    std::ofstream(path("turned.csv")) << turned_gyros();

    const Output output = run("calibrate " + path("turned.csv") + " --json");

    ASSERT_EQ(output.exit_code, 0) << output.error;
    const json mounting = json::parse(output.out)["mounting"];
    ASSERT_EQ(mounting.size(), 3U);
    EXPECT_THAT(mounting[0]["words"].get<std::string>(), HasSubstr("parallel to the body's axes"));
    EXPECT_THAT(mounting[1]["words"].get<std::string>(), HasSubstr("turned by 90 degrees about z"));
    EXPECT_THAT(mounting[2]["words"].get<std::string>(), HasSubstr("turned by 180 degrees about x"));
    const std::array<std::array<double, 4>, 3> truth{{{1, 0, 0, 0}, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}, {0, 1, 0, 0}}};
    for (std::size_t m = 0; m < 3; ++m) {
        double product = 0;
        for (std::size_t i = 0; i < 4; ++i) product += truth[m][i] * mounting[m]["rotation"][i].get<double>();
        EXPECT_GT(std::abs(product), std::cos(0.5 * degree)) << m;
    }
    EXPECT_THAT(run("calibrate " + path("turned.csv")).out, HasSubstr("rotation: ["));
}

TEST_F(CalibrateVerb, says_the_same_of_the_same_sensors_in_two_recordings)
{
    const auto folder = data_dir() / "mimu4444_carlsson";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings under " << data_dir();
    std::vector<json> seen;
    for (const char* const recording : {"exp_1", "exp_2"}) {
        const Output output = run("calibrate " + (folder / recording / "data.bin").string() + " --json");
        ASSERT_EQ(output.exit_code, 0) << output.error;
        seen.push_back(json::parse(output.out));
    }
    EXPECT_GE(seen[0]["rest"].size(), 20U) << "the data page counts 20 static poses";
    for (std::size_t axis = 0; axis < 24; ++axis) {
        const auto& one = seen[0]["axes"][axis];
        const auto& two = seen[1]["axes"][axis];
        EXPECT_NEAR(one["gain"].get<double>(), two["gain"].get<double>(), 0.002) << "axis " << axis;
        EXPECT_NEAR(one["bias_rad_s"].get<double>(), two["bias_rad_s"].get<double>(), 0.15 * degree) << "axis " << axis;
        EXPECT_NEAR(one["limit_rad_s"].get<double>(), 32768 / 16.4 * degree, 1e-9) << "axis " << axis;
        double cosine = 0;
        for (std::size_t i = 0; i < 3; ++i) cosine += one["direction"][i].get<double>() * two["direction"][i].get<double>();
        EXPECT_LT(std::acos(std::min(1.0, cosine)), 0.1 * degree) << "axis " << axis;
    }
    // An independent study found 0.33 ms along and 0.13 ms across.
    EXPECT_NEAR(seen[0]["motion_noise"]["along_s"].get<double>(), 0.33e-3, 0.05e-3);
    EXPECT_NEAR(seen[1]["motion_noise"]["along_s"].get<double>(), 0.33e-3, 0.05e-3);
    EXPECT_NEAR(seen[0]["motion_noise"]["across_s"].get<double>(), 0.13e-3, 0.06e-3);
    EXPECT_NEAR(seen[0]["motion_noise"]["level"].get<double>(), seen[1]["motion_noise"]["level"].get<double>(), 0.1);
}

TEST_F(CalibrateVerb, writes_the_cluster_file_and_the_plot)
{
    const Output csv = run("simulate rest --layout triads-3 --interval 0.01 --duration 30 --noise-rad 1e-5");
    std::ofstream(path("rest.csv")) << csv.out;
    const Output output = run("calibrate " + path("rest.csv") + " --layout triads-3 --out " + path("c.yaml") + " --plot " + path("c.svg"));
    ASSERT_EQ(output.exit_code, 0) << output.error;
    EXPECT_THAT(output.out, AllOf(HasSubstr("1 resting segments"), HasSubstr("nominal axes are kept")));
    EXPECT_THAT(content(path("c.yaml")), AllOf(HasSubstr("origin: \"rest.csv\""), HasSubstr("instrument: \"IMU3\"")));
    EXPECT_THAT(content(path("c.svg")), AllOf(testing::StartsWith("<svg"), HasSubstr("Allan deviation"), testing::EndsWith("</svg>\n")));
}

TEST_F(CalibrateVerb, finds_four_sensors_of_one_flight_in_agreement)
{
    const auto folder = data_dir() / "ansfl_quadrotor_4xDOT" / "Horizontal" / "path_11";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings under " << data_dir();
    std::string arguments = "calibrate --json";
    for (int imu = 1; imu <= 4; ++imu) arguments += " " + (folder / ("IMU_" + std::to_string(imu) + ".csv")).string();
    const Output output = run(arguments);
    ASSERT_EQ(output.exit_code, 0) << output.error;
    EXPECT_THAT(output.error, AllOf(HasSubstr("IMU_4.csv: its clock shows"), HasSubstr("IMU_2.csv:4685:")));
    const json calibration = json::parse(output.out);
    EXPECT_EQ(calibration["rest"].size(), 0U);
    EXPECT_GT(calibration["motion_noise"]["level"], 2) << "separate clocks and aliased vibration are no usual array";
    for (const auto& axis : calibration["axes"]) {
        EXPECT_NEAR(axis["gain"].get<double>(), 1.0, 0.03);
        EXPECT_LT(std::abs(axis["bias_rad_s"].get<double>()), 3 * degree);
    }
}

/// Which axes a calibration of this log sets aside, and what a replay of the log isolates with it.
json calibration_of(const std::string& log)
{
    const Output output = run("calibrate " + log + " --json");
    if (output.exit_code != 0) throw std::runtime_error(output.error);
    return json::parse(output.out);
}

TEST_F(CalibrateVerb, sets_the_soft_axis_of_a_flight_aside_and_its_replay_isolates_that_instrument_alone)
{
    const auto folder = data_dir() / "field";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings under " << data_dir();
    for (const char* const log : {"cats_drone_soft_axis_1.csv", "cats_drone_soft_axis_2.csv"}) {
        SCOPED_TRACE(log);
        const json calibration = calibration_of((folder / log).string());
        const json& outside = calibration["outside_class"];
        ASSERT_EQ(outside.size(), 2U);
        EXPECT_EQ(outside[0]["name"], "g0 y");
        EXPECT_EQ(outside[0]["kind"], "bias");
        EXPECT_NEAR(outside[0]["bias_rad_s"].get<double>(), 9 * degree, 1 * degree);
        EXPECT_EQ(outside[1]["name"], "g0 z");
        EXPECT_EQ(outside[1]["kind"], "gain");
        EXPECT_NEAR(outside[1]["gain"].get<double>(), 0.47, 0.03);
        EXPECT_NEAR(outside[1]["bias_rad_s"].get<double>(), -10.7 * degree, 0.5 * degree);
        EXPECT_EQ(calibration["axes"][2]["gain"], 1.0);
        EXPECT_EQ(calibration["replay"][0]["method"], "field");
        EXPECT_EQ(calibration["replay"][0]["isolated"], "g0");
    }
}

TEST_F(CalibrateVerb, sets_nothing_aside_on_sound_flights_and_field_isolates_nobody_in_their_replay)
{
    const auto folder = data_dir() / "field";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings under " << data_dir();
    for (const char* const log : {"cats_drone_healthy.csv", "cats_rocket_healthy_long.csv", "ardupilot_3_imus_crash.bin"}) {
        SCOPED_TRACE(log);
        const json calibration = calibration_of((folder / log).string());
        EXPECT_TRUE(calibration["outside_class"].empty()) << calibration["outside_class"];
        EXPECT_EQ(calibration["replay"][0]["method"], "field");
        EXPECT_TRUE(calibration["replay"][0]["isolated"].is_null()) << calibration["replay"];
        const bool several_rests = calibration["rest"].size() > 1;
        EXPECT_EQ(calibration["axes"][0]["bias_spread_rad_s"].is_null(), !several_rests);
    }
}

TEST_F(CalibrateVerb, says_of_a_level_that_it_silences_accumulating_only_where_it_does)
{
    const auto folder = data_dir() / "field";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings under " << data_dir();
    const std::string silenced = run("calibrate " + (folder / "cats_drone_healthy.csv").string()).out;
    EXPECT_THAT(silenced, HasSubstr("keeps the accumulating detector silent here"));
    const std::string not_silenced = run("calibrate " + (folder / "cats_rocket_healthy_long.csv").string()).out;
    EXPECT_THAT(not_silenced, HasSubstr("the largest that was tried"));
    EXPECT_THAT(not_silenced, testing::Not(HasSubstr("keeps the accumulating detector silent")));
}

TEST_F(CalibrateVerb, explains_what_it_cannot_calibrate)
{
    const Output moving = run("simulate random --layout orthogonal-3 --interval 0.01 --duration 30 --noise-rad 1e-5");
    std::ofstream(path("moving.csv")) << moving.out;
    EXPECT_THAT(run("calibrate " + path("moving.csv") + " --layout orthogonal-3").error, HasSubstr("no resting segment"));
    EXPECT_THAT(run("calibrate " + path("moving.csv")).error, HasSubstr("--layout"));
    EXPECT_THAT(run("calibrate " + path("moving.csv") + " --layout cone-4").error, HasSubstr("4 axes"));
    EXPECT_THAT(run("calibrate " + path("none.csv")).error, HasSubstr("none.csv"));
    EXPECT_EQ(run("calibrate " + path("none.csv")).exit_code, 2);
}

TEST(SampleStore, gives_back_the_same_samples_from_memory_and_from_its_file)
{
    constexpr std::size_t axes = 24;
    constexpr std::size_t count = 200'000;  // 43 MB: the first 32 MB are in memory
    const auto made = [](std::size_t i) {
        calibration::Sample sample;
        sample.time_s = 0.001 * static_cast<double>(i);
        sample.interval_s = 0.001 + 1e-9 * static_cast<double>(i % 7);
        sample.rate.resize(axes);
        for (Eigen::Index axis = 0; axis < sample.rate.size(); ++axis)
            sample.rate(axis) = std::sin(0.1 * static_cast<double>(i) + static_cast<double>(axis));
        sample.complete = i % 3 != 0;
        sample.follows = i % 5 != 0;
        return sample;
    };
    SampleStore store(axes);
    for (std::size_t i = 0; i < count; ++i) ASSERT_TRUE(store.add(made(i)));
    ASSERT_TRUE(store.flush());
    ASSERT_EQ(store.size(), count);

    const auto expect_same = [&](std::size_t i) {
        const calibration::Sample expected = made(i);
        const calibration::Sample kept = store.at(i);
        ASSERT_EQ(kept.time_s, expected.time_s) << i;
        ASSERT_EQ(kept.interval_s, expected.interval_s) << i;
        ASSERT_EQ(kept.complete, expected.complete) << i;
        ASSERT_EQ(kept.follows, expected.follows) << i;
        ASSERT_EQ(kept.rate, expected.rate) << i;
    };
    for (std::size_t i = 0; i < count; ++i) expect_same(i);
    std::mt19937_64 random(3);
    for (int i = 0; i < 300; ++i) expect_same(random() % count);
}

TEST(SvgPlot, leaves_out_what_an_axis_cannot_show)
{
    const std::string text = svg({{"t", "x", "y", true, true, {{"s", {{1, 1}, {0, 5}, {10, std::nan("")}, {100, 10}}, "#000", false}}}});
    std::size_t marks = 0;
    for (std::size_t at = text.find("<circle"); at != std::string::npos; at = text.find("<circle", at + 1)) ++marks;
    EXPECT_EQ(marks, 2U);
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_THAT(svg({{"empty & <none>", "x", "y", false, false, {}}}), HasSubstr("empty &amp; &lt;none&gt;"));
}

}  // namespace
}  // namespace quorient::cli
