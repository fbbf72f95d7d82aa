#include "quorient/calibration/cluster_file.hpp"
#include "quorient/system/system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <cmath>
#include <filesystem>
#include <fstream>

using namespace quorient;
using testing::AllOf;
using testing::HasSubstr;

namespace {

namespace fs = std::filesystem;

/// A system file of three IMUs on ROS 2, and a calibration of them: the second one is turned by 90 degrees about z, and a little more.
class ImusCalibration : public testing::Test {
protected:
    void SetUp() override
    {
        fs::create_directories(folder_);
        cluster_.description.interval_s = 0.005;
        cluster_.description.axis_count = 9;
        cluster_.description.instrument_count = 3;
        cluster_.motion_level = 1.5;
        cluster_.gain.fill(1);
        for (std::size_t axis = 0; axis < 9; ++axis) {
            const double turned = (axis / 3 == 1 ? 92 : 0) * 3.14159265358979323846 / 180;
            const std::array<std::array<double, 3>, 3> rows{
                {{std::cos(turned), std::sin(turned), 0}, {-std::sin(turned), std::cos(turned), 0}, {0, 0, 1}}};
            cluster_.description.axis[axis] = rows[axis % 3];
            cluster_.description.sigma[axis] = 1e-5;
            cluster_.description.bias[axis] = 0.001 * static_cast<double>(axis);
            cluster_.gain[axis] = 1 + 0.001 * static_cast<double>(axis);
            cluster_.description.instrument[axis] = static_cast<std::uint8_t>(axis / 3);
        }
        name_instruments({"front", "left", "rear"});
    }
    void TearDown() override { fs::remove_all(folder_); }

    void name_instruments(const std::array<std::string, 3>& names)
    {
        for (std::size_t m = 0; m < 3; ++m) {
            cluster_.description.instrument_name[m] = {};
            std::copy(names[m].begin(), names[m].end(), cluster_.description.instrument_name[m].begin());
        }
    }

    tl::expected<system::System, std::string> loaded(const std::string& more = "rate_hz: 200, calibration: cluster.yaml",
                                                     const std::vector<std::string>& set = {})
    {
        std::ofstream(folder_ / "cluster.yaml") << calibration::to_yaml(cluster_);
        std::ofstream(folder_ / "robot.yaml")
            << "domain: 1\nunit: {id: 1}\nsource:\n  kind: ros2_imu\n  imus:\n    - {topic: /imu_1/data, name: front}\n"
            << "    - {topic: /imu_2/data, name: left, rotation: [0.7071067811865476, 0, 0, 0.7071067811865476]}\n"
            << "    - {topic: /imu_3/data, name: rear}\n  " << more.substr(0, more.find(',')) << "\n"
            << (more.find(',') == std::string::npos ? "" : "  " + more.substr(more.find(',') + 2) + "\n")
            << "lanes:\n  - {name: a}\nvoters:\n  - {name: voter-1}\n";
        system::Overrides overrides;
        overrides.set = set;
        return system::load((folder_ / "robot.yaml").string(), overrides);
    }

    calibration::CalibratedCluster cluster_;
    fs::path folder_ = fs::temp_directory_path() / ("quorient-imus-calibration-" + std::to_string(getpid()));
};

}  // namespace

TEST_F(ImusCalibration, takes_the_place_of_the_mountings_and_reaches_the_detectors)
{
    const auto system = loaded();
    ASSERT_TRUE(system) << system.error();
    ASSERT_TRUE(system->sensor.source.calibration);
    EXPECT_EQ(system->sensor.source.calibration->gain[4], 1.004);
    EXPECT_EQ(system->sensor.cluster->axes(3, 0), cluster_.description.axis[3][0]);
    EXPECT_EQ(system->sensor.cluster->sigma(0), 1e-5);
    EXPECT_EQ(system->sensor.source.ros2->rest_s, 0) << "the biases are known";
    EXPECT_TRUE(system->lanes.front().detector.detection.calibrated);
    EXPECT_EQ(system->lanes.front().detector.detection.motion_noise, 1.5);
}

TEST_F(ImusCalibration, is_not_needed_where_a_rest_at_the_start_shows_the_biases)
{
    const auto system = loaded("rate_hz: 200");
    ASSERT_TRUE(system) << system.error();
    EXPECT_FALSE(system->sensor.source.calibration);
    EXPECT_EQ(system->sensor.source.ros2->rest_s, 2);
    EXPECT_FALSE(system->lanes.front().detector.detection.calibrated);
    EXPECT_EQ(loaded("rate_hz: 200, rest_s: 5")->sensor.source.ros2->rest_s, 5);
}

TEST_F(ImusCalibration, of_a_bag_names_the_instruments_by_their_topics)
{
    name_instruments({"/imu_1/data", "/imu_2/data", "/imu_3/data"});
    EXPECT_TRUE(loaded());
}

TEST_F(ImusCalibration, of_other_sensors_is_refused)
{
    name_instruments({"front", "rear", "left"});
    EXPECT_THAT(loaded().error(), AllOf(HasSubstr("robot.yaml"), HasSubstr("other sensors: axis 3 is of instrument rear, here of left")));
}

TEST_F(ImusCalibration, in_another_body_frame_is_refused)
{
    for (std::size_t axis = 3; axis < 6; ++axis) cluster_.description.axis[axis] = cluster_.description.axis[axis - 3];
    EXPECT_THAT(loaded().error(), HasSubstr("axis x of left points 90 deg away"));
}

TEST_F(ImusCalibration, of_another_rate_and_beside_a_stated_noise_is_refused)
{
    EXPECT_THAT(loaded("rate_hz: 100, calibration: cluster.yaml").error(), HasSubstr("state rate_hz: 200"));
    EXPECT_THAT(loaded("rate_hz: 200, calibration: cluster.yaml", {"source.noise_rad=1e-5"}).error(), HasSubstr("noise_rad"));
    EXPECT_THAT(loaded("rate_hz: 200, calibration: cluster.yaml", {"source.rest_s=2"}).error(), HasSubstr("rest_s"));
}

TEST_F(ImusCalibration, and_mountings_hold_for_the_replay_of_what_the_file_recorded)
{
    const std::vector<std::string> replay{"source.kind=log", "source.file=flight.mcap"};
    const auto plain = loaded("rate_hz: 200, rest_s: 5", replay);
    ASSERT_TRUE(plain) << plain.error();
    EXPECT_NEAR(plain->sensor.cluster->axes(3, 1), 1, 1e-12);
    EXPECT_EQ(plain->sensor.source.log->rest_s, 0) << "the recorded increments have no biases any more";
    EXPECT_TRUE(plain->sensor.source.log->of_imus);

    const auto calibrated = loaded("rate_hz: 200, calibration: cluster.yaml", replay);
    ASSERT_TRUE(calibrated) << calibrated.error();
    EXPECT_EQ(calibrated->sensor.cluster->axes(3, 0), cluster_.description.axis[3][0]);
    EXPECT_TRUE(calibrated->lanes.front().detector.detection.calibrated);
}
