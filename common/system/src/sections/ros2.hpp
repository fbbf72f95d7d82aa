#pragma once

#include "quorient/configuration/table.hpp"
#include "quorient/system/system.hpp"
#include "source.hpp"

#include <cstddef>

namespace quorient::system {

inline constexpr std::size_t axes_per_imu = 3;

/// `imus`, for their own source and for the replay of its recording.
configuration::Rows<SourceSection> imus_row();

/// `source: {kind: ros2_imu, …}`.
configuration::Rows<SourceSection> ros2_source_rows();

/// `ros2`: what every voter sends to ROS 2.
const configuration::Table<Ros2OutputSettings>& ros2_output_table();

}  // namespace quorient::system
