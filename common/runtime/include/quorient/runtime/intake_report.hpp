#pragma once

#include "quorient/runtime/frame_intake.hpp"
#include "quorient/runtime/node.hpp"

#include <string>

namespace quorient::runtime {

/// What a publisher does wrong, in words for the person who wrote it.
std::string words_for(const FrameIntake::Complaint& complaint);

/// Copies the intake's counts into the service's status and reports refused input and foreign publishers as they come.
/// @param told_rejected, told_foreign  what was reported already; kept by the caller. Every kind of mistake is reported once a second at most.
void report_intake(const FrameIntake& intake, Node& node, std::uint64_t& told_rejected, std::uint64_t& told_foreign);

}  // namespace quorient::runtime
