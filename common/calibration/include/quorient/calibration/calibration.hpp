#pragma once

#include "quorient/calibration/cluster_file.hpp"
#include "quorient/calibration/consensus.hpp"
#include "quorient/calibration/motion_noise.hpp"
#include "quorient/calibration/rest.hpp"
#include "quorient/messages/cluster_description.hpp"

#include <array>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::calibration {

/// Everything that a recording shows about its sensors. [docs/methods/calibration.md]
struct Calibration {
    CalibratedCluster cluster;  ///< what a publisher needs
    std::vector<Segment> rest;  ///< empty: they never rested, see calibrate
    RestFigures at_rest;
    std::vector<AllanPoint> allan;
    AllanFigures allan_figures;           ///< empty vectors without rest
    std::optional<MotionFigures> motion;  ///< absent where the axes could not be fitted
    std::string axes_note;                ///< why the nominal axes were kept, or empty
    std::vector<OutsideClass> outside;    ///< axes that were set aside: not calibrated, and nothing else is fitted to them
    double axes_residual_rad_s = 0;
    std::array<double, max_axes> misalignment_rad{};        ///< angle between fitted and nominal axis
    std::array<std::uint64_t, max_axes> saturated{};        ///< samples at the axis's limit
    std::array<double, max_axes> saturation_limit_rad_s{};  ///< the extreme value that came again and again; 0 = never reached
};

/// Where the sensors never rested, the axes' disagreement takes the place of rest. The biases are those in which the axes differ; their
/// common part cannot be distinguished from motion and stays 0. Sigma is the disagreement over all the log's motion.
///
/// An axis outside its class is set aside: it keeps its nominal direction, a gain of 1, no bias, and the noise of the other axes, so that a
/// detector sees its fault.
///
/// @param nominal  axes, instruments, names, range, quantum and interval of the log.
/// @returns an error if the sensors never rested and have no redundancy either, or an axis is constant or of unknown direction.
tl::expected<Calibration, std::string> calibrate(Samples samples, const ClusterDescription& nominal, const RestSettings& settings = {});

}  // namespace quorient::calibration
