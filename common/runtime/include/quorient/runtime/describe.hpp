#pragma once

#include "quorient/messages/cluster_description.hpp"

#include <cstdint>
#include <string>

namespace quorient::runtime {

/// As describe_axes(mask) of text.hpp; channels of a vessel by their own names: "channel 1 (yaw_rate)", "no channel".
std::string describe_axes(std::uint32_t mask, const ClusterDescription& description);

}  // namespace quorient::runtime
