#pragma once

#include "quorient/recording/instrument_log.hpp"
#include "quorient/recording/reader.hpp"

#include <span>
#include <vector>

namespace quorient::recording {

/// How one log's clock stands against another's.
struct ClockOffset {
    double offset_s = 0;     ///< what this log's time shows when the other's shows 0 (times as RecordedFrame::time_ns)
    double correlation = 0;  ///< between the two logs' rates of turn at that offset, 1 = alike
};

/// Compares how fast the two logs' first triads turned (a figure that no mounting changes) at all offsets up to `longest_s` either way.
/// @returns an error if no offset makes them alike: different motions, or none.
tl::expected<ClockOffset, std::string> estimate_offset(const std::filesystem::path& reference, const std::filesystem::path& other,
                                                       double longest_s = 3.0, const LogOptions& options = {});

struct MergedLogs {
    std::unique_ptr<Reader> reader;
    std::vector<ClockOffset> offsets;  ///< for each log, against the first one, whose own is 0
    std::vector<std::string> remarks;  ///< on how the logs were understood: "gyros read as deg/s, since …"
};

/// Several logs of one motion as one cluster: the axes of all logs, at the sample times of the first log. The increments of the others are
/// split at these times as if their rates were constant within each of their intervals, so no rotation is lost or counted twice. Where a
/// log has no data its axes are not valid. Logs that begin or end within one second of each other were switched on and off by hand:
/// the common log begins when all have begun and ends with the first of them. Each log keeps its own mounting; `quorient calibrate`
/// finds the mountings. The files of one rotated record of Quorient are no different sensors: they are read one after the other.
/// @returns an error as open_log and estimate_offset do, or if there are more than 24 axes.
tl::expected<MergedLogs, std::string> open_logs(std::span<const std::filesystem::path> files, const LogOptions& options = {});

}  // namespace quorient::recording
