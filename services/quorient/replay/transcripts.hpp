#pragma once

#include "cli/output_file.hpp"
#include "offline.hpp"

namespace quorient::replay {

/// Writes the verdict of each frame and lane as a row of a CSV, which is made with the first of them:
/// time_s,lane,sequence,state,isolated,suspect,left_out,statistic,threshold,detectable_remaining. Axes are numbers with blanks between them.
void write_verdicts(Offline& offline, const system::System& system, cli::OutputFile& out);

/// Writes each event of each process as a line of JSON: time_s, source, severity, code, axes, sequence, text. The time is that of the newest
/// frame at that moment.
void write_events(Offline& offline, cli::OutputFile& out);

}  // namespace quorient::replay
