#pragma once

#include "quorient/calibration/correction.hpp"
#include "quorient/calibration/motion_noise.hpp"
#include "quorient/calibration/sample.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/limits.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <tl/expected.hpp>

namespace quorient::calibration {

/// A cluster as calibrated.
struct CalibratedCluster {
    ClusterDescription description;           ///< axes, bias, sigma, range … of the corrected increments
    std::array<double, max_axes> gain{};
    std::array<double, max_axes> bias_spread_rad_s{};
    SamplingJitter jitter;
    double motion_level = 0;                  ///< times the motion noise that is usual for arrays; 0 = not known
    std::optional<fdi::MotionNoise> gated{};  ///< nothing where the recording does not show it
    std::string origin;                       ///< which log it comes from

    /// Makes corrected increments of what these sensors measured.
    Correction correction() const { return {description.bias, gain}; }

    /// What this axis measured in a raw sample, as a corrected increment.
    double corrected(const Sample& sample, std::size_t axis) const
    {
        return correction().increment_of_rate(axis, sample.rate(static_cast<Eigen::Index>(axis)), sample.interval_s);
    }
};

/// The YAML text of a cluster file; doubles read back bit-identical.
std::string to_yaml(const CalibratedCluster& cluster);

/// @returns every problem of the text at once, one per line with name:line:column.
tl::expected<CalibratedCluster, std::string> parse_cluster(const std::string& text, const std::string& name);

/// Reads a cluster file.
tl::expected<CalibratedCluster, std::string> load_cluster(const std::string& file);

}  // namespace quorient::calibration
