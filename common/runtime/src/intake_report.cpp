#include "quorient/runtime/intake_report.hpp"

#include "quorient/messages/meaning.hpp"

#include <fmt/format.h>

namespace quorient::runtime {

namespace {

using Fault = intake::FrameIntake::Fault;

EventCode code_of(Fault fault)
{
    const bool missing = fault == Fault::unknown_revision || fault == Fault::no_description;
    return missing ? EventCode::unknown_revision : EventCode::rejected_input;
}

}  // namespace

void IntakeReport::update(const intake::FrameIntake& intake)
{
    const auto& counters = intake.counters();
    auto& status = node_.status();
    status.gaps = counters.gaps;
    status.duplicates = counters.duplicates;
    status.late = counters.late;
    status.foreign = counters.foreign;
    status.rejected = counters.rejected_frames + counters.rejected_values + counters.waiting_lost;
    if (intake.complaints() != reported_complaints_) {
        const auto& complaint = intake.complaint();
        const AxisMask axes = complaint.fault == Fault::value ? axis_bit(complaint.got) : 0;
        if (node_.report_throttled(code_of(complaint.fault), Severity::warning_low, complaint.identity, axes,
                                   fmt::format("{} ({} refused so far)", intake::words_for(complaint), status.rejected)))
            reported_complaints_ = intake.complaints();
    }
    if (intake.foreign_epoch() != reported_foreign_epoch_) {
        reported_foreign_epoch_ = intake.foreign_epoch();
        node_.report(EventCode::foreign_publisher, Severity::warning_high, intake.newest(), 0,
                     fmt::format("a second publisher of unit {} (epoch {}) is ignored while the first one sends", node_.settings().unit,
                                 reported_foreign_epoch_));
    }
}

}  // namespace quorient::runtime
