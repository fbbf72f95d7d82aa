#pragma once

#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi::field {

/// Above this certainty of a lasting contradiction nothing is learned: a fault must not be learned away.
inline constexpr double largest_learned_from = 0.6;

/// How long a contradiction keeps learning off after it.
inline constexpr double disturbance_memory = 0.9;  ///< per frame

/// After so long a silence a sensor has been switched off: nothing is known of its bias.
inline constexpr double forgotten_after_s = 5;

/// Nothing is learned before the noise of the differences is known: with too small a noise the first frames would be taken for certain.
inline constexpr double noise_known_s = 0.5;

/// A fault that began no later after the first comparison has been learned from.
inline constexpr double misled_s = 1;

inline constexpr std::uint64_t frames_between_diagnoses = 10;

/// Time from one frame's first measurement to the next frame's, of the same epoch [s].
inline double time_between_s(std::uint64_t earlier, std::uint64_t later, double interval_s)
{
    return later > earlier ? static_cast<double>(later - earlier) * interval_s : 0;
}

/// What the comparison of any sensors needs to be known.
inline tl::expected<void, std::string> check(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (!(cluster.interval_s > 0)) return tl::unexpected(std::string("field: the cluster's interval_s must be known"));
    if (settings.delay_class_s && !(*settings.delay_class_s > 0))
        return tl::unexpected("field: the delay class must be above 0 s, got " + std::to_string(*settings.delay_class_s));
    return {};
}

}  // namespace quorient::fdi::field
