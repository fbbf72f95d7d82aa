#pragma once

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/sensor_frame.hpp"

#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::studies {

/// A log of instruments that each measure all three directions, as it was measured: nothing is calibrated.
struct FieldLog {
    std::string name;
    geometry::SensorCluster cluster;
    std::vector<SensorFrame> frames;

    std::size_t instruments() const { return cluster.instrument_name.size(); }
    double duration_s() const;
};

/// A file is read as replay reads it; of a folder, all CSV files are the logs of one motion, whose clocks are tied by it.
/// A log that does not say where its axes point is taken for parallel triads: x, y, z of one instrument after the other.
/// @returns what cannot be read, naming the file.
tl::expected<FieldLog, std::string> load_field_log(const std::filesystem::path& file);

/// These instruments alone.
FieldLog part_of(const FieldLog& log, const std::vector<std::size_t>& instruments);

/// The sets of instruments that a log is judged with: all, and of five or more smaller ones too.
std::vector<std::vector<std::size_t>> instrument_sets(std::size_t instruments);

}  // namespace quorient::studies
