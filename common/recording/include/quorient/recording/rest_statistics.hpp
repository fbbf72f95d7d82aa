#pragma once

#include "quorient/recording/reader.hpp"

namespace quorient::recording {

/// Bias and noise of the sensors, from a log's beginning while nothing moves.
struct RestStatistics {
    std::array<double, max_axes> bias_rad_s{};
    std::array<double, max_axes> sigma_rad{};  ///< noise of one increment at the mean interval, bias removed
    std::uint64_t samples = 0;
    double duration_s = 0;
    std::array<double, max_axes> acceleration_m_s2{};  ///< mean of each accelerometer axis
    AxisMask acceleration_mask = 0;                    ///< accelerometer axes that the log has in every such frame
    AxisMask constant_mask = 0;                        ///< axes that never changed: dead, or coarser than their noise
};

/// Reads the first seconds of a log that has just been opened.
/// @param moving_rad_s  standard deviation of a rate above which the sensors are not at rest.
/// @returns an error that names the axis if they moved, or if fewer than 10 samples of an axis are there.
tl::expected<RestStatistics, std::string> rest_statistics(Reader& reader, double seconds, double moving_rad_s = 0.05);

}  // namespace quorient::recording
