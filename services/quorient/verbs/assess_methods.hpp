#pragma once

#include "cli/json_output.hpp"
#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::cli {

/// One detection method as `quorient assess` offers it.
struct AssessMethod {
    std::string name;
    std::vector<std::string> options;  ///< those that it takes, as typed
    std::string fields;                ///< what it adds to each row, for --help
};

/// All of them, in the order of the manual.
const std::vector<AssessMethod>& assess_methods();

/// A detector, and what its method adds to the JSON object of the row it has assessed last.
struct Assessor {
    std::unique_ptr<fdi::Detector> detector;
    std::function<void(const fdi::Assessment&, Json&)> add_fields;
};

/// @param direction  of an additional interval (body frame), for `guaranteed` only.
/// @returns why this method cannot serve this cluster with these settings.
tl::expected<Assessor, std::string> make_assessor(const fdi::DetectorSettings& settings, const geometry::SensorCluster& cluster,
                                                  const std::optional<Eigen::Vector3d>& direction);

}  // namespace quorient::cli
