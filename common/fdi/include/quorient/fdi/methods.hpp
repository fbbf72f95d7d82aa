#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::fdi {

/// What a method needs to say anything.
enum class MethodInput : std::uint8_t {
    row,          ///< one measurement of all axes
    rows,         ///< consecutive frames of one cluster of axes
    instruments,  ///< consecutive frames of instruments that each measure all three directions
};

/// One detection method: the only place where it is registered. `quorient assess`, the system file, the tests, the benchmark and the
/// README's table all read these rows.
struct Method {
    using Make = tl::expected<std::unique_ptr<Detector>, std::string> (*)(const DetectorSettings&, const geometry::SensorCluster&);

    std::string_view word;     ///< in the system file; its class is <Word>Detector
    std::string_view axes;     ///< the range of n that it allows
    std::string_view summary;  ///< one line
    MethodInput input;
    std::vector<std::string_view> settings;  ///< those that it reads, as command line options without dashes
    std::string_view details;                ///< names of Detector::details()
    Make make;
};

/// All methods, `auto` first.
std::span<const Method> methods();

/// @returns nothing where no method has this name.
const Method* find_method(std::string_view word);

/// The method of settings.method on this cluster. `auto`: `vector` on four axes (parity alone cannot isolate there); `field` on
/// three or more instruments that each measure all three directions, unless settings.margin or max_faults ask for more; likewise `field` on
/// five or more single axes whose noise neither the settings nor the cluster state; else `subset` where settings.instruments; else `glt` with
/// the margin of `subset`.
/// @returns why not: an unknown name (with the known ones), a number of axes the method does not allow, a figure out of range, or
///          noise that is known neither from the settings nor from the cluster.
tl::expected<std::unique_ptr<Detector>, std::string> make_detector(const DetectorSettings& settings,
                                                                   const geometry::SensorCluster& cluster);

}  // namespace quorient::fdi
