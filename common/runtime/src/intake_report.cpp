#include "quorient/runtime/intake_report.hpp"

#include <fmt/format.h>

namespace quorient::runtime {

void report_intake(const FrameIntake& intake, Node& node, std::uint64_t& told_rejected, std::uint64_t& told_foreign)
{
    const auto& counters = intake.counters();
    auto& status = node.status();
    status.gaps = counters.gaps;
    status.duplicates = counters.duplicates;
    status.late = counters.late;
    status.foreign = counters.foreign;
    status.rejected = counters.rejected_frames + counters.rejected_values + counters.waiting_lost;
    if (status.rejected > told_rejected) {
        told_rejected = status.rejected;
        node.report_throttled(EventCode::rejected_input, Severity::warning_low, intake.newest(), 0,
                              fmt::format("refused so far: {} frames, {} values, {} frames without a description", counters.rejected_frames,
                                          counters.rejected_values, counters.waiting_lost));
    }
    if (intake.foreign_epoch() != told_foreign) {
        told_foreign = intake.foreign_epoch();
        node.report(EventCode::foreign_publisher, Severity::warning_high, intake.newest(), 0,
                    fmt::format("a second publisher of unit {} (epoch {}) is ignored while the first one sends", node.settings().unit,
                                told_foreign));
    }
}

}  // namespace quorient::runtime
