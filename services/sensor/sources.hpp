#pragma once

#include "frame_source.hpp"

namespace quorient::sensor {

/// @param settings  checked by the system file's loader.
std::unique_ptr<FrameSource> make_simulation_source(const system::SensorSettings& settings, std::uint64_t epoch);

std::unique_ptr<FrameSource> make_vessel_source(const system::SensorSettings& settings, std::uint64_t epoch);

std::unique_ptr<FrameSource> make_ros2_source(const system::SensorSettings& settings, std::uint64_t epoch);

tl::expected<std::unique_ptr<FrameSource>, std::string> make_log_source(const system::SensorSettings& settings, std::uint64_t epoch,
                                                                        const recording::LogOptions& options);

}  // namespace quorient::sensor
