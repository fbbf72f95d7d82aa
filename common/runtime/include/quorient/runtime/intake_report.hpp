#pragma once

#include "quorient/intake/frame_intake.hpp"
#include "quorient/runtime/node.hpp"

#include <cstdint>

namespace quorient::runtime {

/// Copies the intake's counts into the service's status, and reports refused input and foreign publishers as they come. Every kind of
/// mistake is reported once a second at most.
class IntakeReport {
public:
    explicit IntakeReport(Node& node) : node_(node) {}

    /// Frames have been offered to the intake.
    void update(const intake::FrameIntake& intake);

private:
    Node& node_;
    std::uint64_t reported_complaints_ = 0;
    std::uint64_t reported_foreign_epoch_ = 0;
};

}  // namespace quorient::runtime
