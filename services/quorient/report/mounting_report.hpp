#pragma once

#include "cli/json_output.hpp"
#include "quorient/messages/cluster_description.hpp"

#include <string>

namespace quorient::cli {

/// How each instrument of three axes stands in the body frame, by its calibrated axes: in words and as the `rotation:` line of `source.imus`
/// in a system file. The rotation nearest to the three axes is meant. Empty where there are fewer than two such instruments.
std::string mounting_text(const ClusterDescription& cluster);

/// instrument, rotation (w, x, y, z; null for left-handed axes), words.
Json mounting_json(const ClusterDescription& cluster);

}  // namespace quorient::cli
