#pragma once

#include "run_timeline.hpp"

#include <string>

namespace quorient::report {

/// A run over time as an SVG file that needs nothing else: attitude error (attitude, where no truth is known), what each lane decided by
/// against its threshold, which axes were faulty and left out, and the level.
std::string run_picture(const system::System& system, const evaluation::RunObserver& run, const RunTimeline& timeline);

}  // namespace quorient::report
