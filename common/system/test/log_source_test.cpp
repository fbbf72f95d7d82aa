#include "quorient/calibration/cluster_file.hpp"
#include "quorient/system/system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <filesystem>
#include <fstream>

using namespace quorient;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

namespace fs = std::filesystem;

/// A folder with a system file, a log and a calibration, and another folder where the process is started.
class LogSource : public testing::Test {
protected:
    void SetUp() override
    {
        fs::create_directories(folder_ / "logs");
        fs::create_directories(elsewhere_);
        calibration::CalibratedCluster cluster;
        cluster.description.interval_s = 0.016;
        cluster.description.axis_count = 9;
        cluster.gain.fill(1);
        cluster.motion_level = 1.5;
        cluster.gated = {.jitter_along_s = 1e-3, .jitter_across_s = 2e-4, .axes_error = 3e-3, .rate_error = 4e-4};
        for (std::size_t axis = 0; axis < 9; ++axis) {
            cluster.description.axis[axis][axis % 3] = 1;
            cluster.description.sigma[axis] = 1e-5;
            cluster.description.instrument[axis] = static_cast<std::uint8_t>(axis / 3);
            cluster.description.instrument_name[axis / 3] = {'I', 'M', 'U', static_cast<char>('1' + axis / 3)};
        }
        cluster.description.instrument_count = 3;
        std::ofstream(folder_ / "cluster.yaml") << calibration::to_yaml(cluster);
        before_ = fs::current_path();
        fs::current_path(elsewhere_);
    }

    void TearDown() override
    {
        fs::current_path(before_);
        fs::remove_all(folder_);
        fs::remove_all(elsewhere_);
    }

    tl::expected<system::System, std::string> loaded(const std::string& source, const std::string& detector = "{}") const
    {
        std::ofstream(folder_ / "system.yaml") << "domain: 1\nunit: {id: 1}\nsource: {kind: log, rest_s: 0, " << source
                                               << "}\nlanes:\n  - {name: a, detector: " << detector << "}\nvoters:\n  - {name: voter-1}\n";
        return system::load((folder_ / "system.yaml").string(), {});
    }

    fs::path folder_ = fs::temp_directory_path() / ("quorient-log-source-" + std::to_string(getpid()));
    fs::path elsewhere_ = folder_.string() + "-elsewhere";
    fs::path before_;
};

}  // namespace

TEST_F(LogSource, names_its_files_from_the_folder_of_the_system_file)
{
    const auto system = loaded("file: [logs/a.csv, b.csv], calibration: cluster.yaml");
    ASSERT_TRUE(system) << system.error();
    EXPECT_THAT(system->sensor.source.log->files, ElementsAre((folder_ / "logs/a.csv").string(), (folder_ / "b.csv").string()));
    ASSERT_TRUE(system->sensor.source.calibration);
    EXPECT_EQ(system->sensor.source.calibration->description.axis_count, 9);
}

TEST_F(LogSource, takes_absolute_names_as_they_are)
{
    const auto system = loaded("file: /data/a.csv, calibration: " + (folder_ / "cluster.yaml").string());
    ASSERT_TRUE(system) << system.error();
    EXPECT_THAT(system->sensor.source.log->files, ElementsAre("/data/a.csv"));
}

TEST_F(LogSource, does_not_look_for_its_calibration_where_the_process_was_started)
{
    fs::rename(folder_ / "cluster.yaml", elsewhere_ / "cluster.yaml");
    const auto system = loaded("file: a.csv, calibration: cluster.yaml");
    ASSERT_FALSE(system);
    EXPECT_THAT(system.error(), HasSubstr((folder_ / "cluster.yaml").string()));
}

TEST_F(LogSource, needs_no_rest_where_all_detectors_measure_biases_and_noise_themselves)
{
    const auto rest_s = [&](const std::string& method) {
        std::ofstream(folder_ / "rest.yaml") << "domain: 1\nunit: {id: 1}\nsource: {kind: log, file: a.csv}\nlanes:\n"
                                             << "  - {name: a, detector: {method: field}}\n  - {name: b, detector: {method: " << method
                                             << "}}\nvoters:\n  - {name: voter-1}\n";
        return system::load((folder_ / "rest.yaml").string()).value().sensor.source.log->rest_s;
    };
    EXPECT_EQ(rest_s("field"), 0);
    EXPECT_EQ(rest_s("glt"), 10);
}

TEST_F(LogSource, tells_the_detectors_the_gated_terms_of_its_calibration)
{
    const auto gated = loaded("file: a.csv, calibration: cluster.yaml")->lanes.front().detector.detection.gated_noise;
    ASSERT_TRUE(gated);
    EXPECT_EQ(gated->jitter_along_s, 1e-3);
    EXPECT_EQ(gated->jitter_across_s, 2e-4);
    EXPECT_EQ(gated->axes_error, 3e-3);
    EXPECT_EQ(gated->rate_error, 4e-4);
    EXPECT_FALSE(loaded("file: a.csv")->lanes.front().detector.detection.gated_noise);
}

TEST_F(LogSource, tells_the_detectors_the_motion_noise_of_its_calibration_unless_they_are_told_another)
{
    EXPECT_EQ(loaded("file: a.csv, calibration: cluster.yaml")->lanes.front().detector.detection.motion_noise, 1.5);
    EXPECT_EQ(loaded("file: a.csv, calibration: cluster.yaml", "{motion_noise: 3}")->lanes.front().detector.detection.motion_noise, 3);
    EXPECT_EQ(loaded("file: a.csv")->lanes.front().detector.detection.motion_noise, std::nullopt);
    EXPECT_THAT(loaded("file: a.csv", "{motion_noise: 0}").error(), HasSubstr("motion_noise"));
}
