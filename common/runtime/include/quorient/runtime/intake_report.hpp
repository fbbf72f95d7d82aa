#pragma once

#include "quorient/runtime/frame_intake.hpp"
#include "quorient/runtime/node.hpp"

namespace quorient::runtime {

/// Copies the intake's counts into the service's status and tells of refused input and foreign publishers as they come.
/// @param told_rejected, told_foreign  what was told already; kept by the caller.
void report_intake(const FrameIntake& intake, Node& node, std::uint64_t& told_rejected, std::uint64_t& told_foreign);

}  // namespace quorient::runtime
