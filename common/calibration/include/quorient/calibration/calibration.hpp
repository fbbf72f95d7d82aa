#pragma once

#include "quorient/calibration/cluster_file.hpp"
#include "quorient/calibration/motion_noise.hpp"
#include "quorient/calibration/rest.hpp"
#include "quorient/messages/cluster_description.hpp"

#include <array>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::calibration {

/// Everything that a recording tells of its sensors.
struct Calibration {
    CalibratedCluster cluster;  ///< what a publisher needs
    std::vector<Segment> rest;
    RestFigures at_rest;
    std::vector<AllanPoint> allan;
    AllanFigures allan_figures;
    std::optional<MotionFigures> motion;  ///< absent where the axes could not be fitted
    std::string axes_note;                ///< why the nominal axes were kept, or empty
    double axes_residual_rad_s = 0;
    std::array<double, max_axes> misalignment_rad{};        ///< angle between fitted and nominal axis
    std::array<std::uint64_t, max_axes> saturated{};        ///< samples at the axis's limit
    std::array<double, max_axes> saturation_limit_rad_s{};  ///< the extreme value that came again and again; 0 = never reached
};

/// @param nominal  axes, instruments, names, range, quantum and interval of the log.
/// @returns an error if the sensors never rested, or an axis is constant, NaN or of unknown direction.
tl::expected<Calibration, std::string> calibrate(Samples samples, const ClusterDescription& nominal, const RestSettings& settings = {});

}  // namespace quorient::calibration
