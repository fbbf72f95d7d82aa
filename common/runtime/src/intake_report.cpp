#include "quorient/runtime/intake_report.hpp"

#include "quorient/messages/meaning.hpp"

#include <fmt/format.h>

namespace quorient::runtime {

std::string words_for(const FrameIntake::Complaint& complaint)
{
    using Fault = FrameIntake::Fault;
    const auto& [fault, identity, got, expected, why] = complaint;
    switch (fault) {
        case Fault::none:
            break;
        case Fault::description:
            return fmt::format("a description is refused: {}", why);
        case Fault::axis_count:
            return fmt::format("frame {} has {} axes, its description {}", identity.sequence, got, expected);
        case Fault::interval:
            return fmt::format("frame {}: its interval must be 1 ns to an hour", identity.sequence);
        case Fault::sample_time:
            return fmt::format(
                "frame {}: its sample time is not after that of the frame before, or farther than 146 years from its clock's origin",
                identity.sequence);
        case Fault::unknown_revision:
            return fmt::format("frames refer to revision {} of the description; of this epoch, {} is the newest here", got, expected);
        case Fault::no_description:
            return fmt::format("frames of epoch {} come without a description: publish it, latched, with the same epoch", identity.epoch);
        case Fault::sequence_restart:
            return fmt::format("sequence {} after {} in one epoch: who counts again must choose a new, larger epoch", got, expected);
        case Fault::value:
            return fmt::format("frame {}: axis {} is not finite, or beyond its stated range", identity.sequence, got);
    }
    return {};
}

namespace {

EventCode code_of(FrameIntake::Fault fault)
{
    const bool missing = fault == FrameIntake::Fault::unknown_revision || fault == FrameIntake::Fault::no_description;
    return missing ? EventCode::unknown_revision : EventCode::rejected_input;
}

}  // namespace

void report_intake(const FrameIntake& intake, Node& node, std::uint64_t& told_rejected, std::uint64_t& told_foreign)
{
    const auto& counters = intake.counters();
    auto& status = node.status();
    status.gaps = counters.gaps;
    status.duplicates = counters.duplicates;
    status.late = counters.late;
    status.foreign = counters.foreign;
    status.rejected = counters.rejected_frames + counters.rejected_values + counters.waiting_lost;
    if (intake.complaints() != told_rejected) {
        const auto& complaint = intake.complaint();
        const AxisMask axes = complaint.fault == FrameIntake::Fault::value ? axis_bit(complaint.got) : 0;
        if (node.report_throttled(code_of(complaint.fault), Severity::warning_low, complaint.identity, axes,
                                  fmt::format("{} ({} refused so far)", words_for(complaint), status.rejected)))
            told_rejected = intake.complaints();
    }
    if (intake.foreign_epoch() != told_foreign) {
        told_foreign = intake.foreign_epoch();
        node.report(EventCode::foreign_publisher, Severity::warning_high, intake.newest(), 0,
                    fmt::format("a second publisher of unit {} (epoch {}) is ignored while the first one sends", node.settings().unit,
                                told_foreign));
    }
}

}  // namespace quorient::runtime
