#pragma once

#include "offline.hpp"

#include <ostream>

namespace quorient::replay {

/// Writes the verdict of each frame and lane as a row of a CSV:
/// time_s,lane,sequence,state,isolated,suspect,left_out,statistic,threshold,detectable_remaining. Axes are numbers with blanks between them.
void write_verdicts(Offline& offline, const system::System& system, std::ostream& out);

/// Writes each event of each process as a line of JSON: time_s, source, severity, code, axes, sequence, text. The time is that of the newest
/// frame at that moment.
void write_events(Offline& offline, std::ostream& out);

}  // namespace quorient::replay
