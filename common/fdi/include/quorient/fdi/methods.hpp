#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::fdi {

struct MethodEntry {
    std::string_view name;
    std::string_view axes;     ///< the range of n it allows
    std::string_view summary;  ///< one line
};

/// The methods that make_detector knows by name, `auto` first.
const std::vector<MethodEntry>& methods();

/// The method of settings.method on this cluster. `auto`: `vector` on four axes (parity alone cannot isolate there); `accumulating` on
/// three or more instruments that each measure all three directions, unless settings.margin or max_faults ask for more; else `subset`
/// where settings.instruments; else `glt` with the margin of `subset`.
/// @returns why not: an unknown name (with the known ones), a number of axes the method does not allow, a figure out of range, or
///          noise that is known neither from the settings nor from the cluster.
tl::expected<std::unique_ptr<Detector>, std::string> make_detector(const DetectorSettings& settings,
                                                                   const geometry::SensorCluster& cluster);

}  // namespace quorient::fdi
