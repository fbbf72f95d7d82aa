#pragma once

#include "quorient/calibration/calibration.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/recording/reader.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::studies {

/// A recording in memory, as measured, and the calibration that it gives.
struct Recording {
    std::string name;
    std::vector<calibration::Sample> samples;
    std::vector<std::uint64_t> sequence;  ///< one per sample; lost samples leave a gap
    ClusterDescription nominal;           ///< as the log describes its sensors
    calibration::Calibration calibration;
};

/// @returns what cannot be read or calibrated, naming the file.
tl::expected<Recording, std::string> load_recording(const std::filesystem::path& log);

/// Some instruments of a recording, with the biases, gains and axes that another recording of the same sensors gave.
struct RecordedArray {
    std::string name;               ///< e.g. "exp_1, IMU1 IMU3 IMU5"
    std::size_t recording = 0;      ///< place in the list of recordings
    std::size_t calibrated_by = 0;  ///< place of the other one
    geometry::SensorCluster cluster;
    std::optional<double> motion_noise{};          ///< fdi::DetectorSettings::motion_noise, as the other recording shows it
    std::optional<fdi::MotionNoise> gated_noise{};  ///< likewise
    std::vector<SensorFrame> frames;
    std::vector<calibration::Segment> rest;
    calibration::Segment motion;  ///< the longest stretch without rest

    double duration_s() const;
};

/// @param instruments  places in the recording's list of instruments.
/// @returns why the two recordings are not of the same sensors.
tl::expected<RecordedArray, std::string> corrected(const Recording& recording, const calibration::CalibratedCluster& calibration,
                                                   const std::vector<std::size_t>& instruments);

tl::expected<std::vector<Recording>, std::string> load_recordings(const std::vector<std::filesystem::path>& logs);

/// Every recording, calibrated by the next one: three of its instruments where it has five or more, and all.
tl::expected<std::vector<RecordedArray>, std::string> cross_corrected(const std::vector<Recording>& recordings);

/// The same from logs.
tl::expected<std::vector<RecordedArray>, std::string> load_arrays(const std::vector<std::filesystem::path>& logs);

}  // namespace quorient::studies
