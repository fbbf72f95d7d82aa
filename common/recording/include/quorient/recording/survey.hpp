#pragma once

#include "quorient/recording/instrument_clock.hpp"
#include "quorient/recording/timing.hpp"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::recording {

/// A sample as the survey keeps it.
struct KeptSample {
    std::int64_t time_ns = 0;  ///< stamp, by the log's clock
    std::array<float, 3> rate_rad_s{};
};

/// What one instrument measured in one stretch of the log.
using KeptWindow = std::vector<KeptSample>;

/// How an instrument's clock stands to the others'. Times are since the origin of its log.
struct ClockFigures {
    bool tied = false;         ///< the motion shows offset and slope; else they are 0
    double offset_s = 0;       ///< what this clock shows when the reference shows 0
    double slope = 0;          ///< seconds that it gains per second
    double uncertainty_s = 0;  ///< standard deviation of the offsets that single stretches show
    double correlation = 0;    ///< correlation of the rates of turn at that offset, 1 = alike
    bool own_clock = false;    ///< samples are placed on the instrument's own clock: its stamps came late
    double own_period_s = 0;   ///< its period, where own_clock
    double late_median_s = 0;  ///< lateness of its stamps
    double late_99_s = 0;
    double late_most_s = 0;
    std::uint64_t lost = 0;    ///< whole samples missing between the stamps
};

/// An instrument of the logs, as a first reading found it.
struct SurveyedInstrument {
    Instrument instrument;
    std::size_t log = 0;    ///< place of its log
    std::size_t place = 0;  ///< its place in that log
    InstrumentFigures figures;
    std::vector<RateChange> rate_changes;
    std::optional<double> arrival_period_s;  ///< by the earliest arrivals
    std::vector<KeptWindow> windows;         ///< by number of the stretch; empty where nothing was kept; tie_clocks gives them up
    ClockFigures clock;

    /// Largest rate of an axis, as it is stated or else as its values show it; 0 where nothing does.
    double range_rad_s(std::size_t axis) const
    {
        const auto& reached = figures.range_reached[axis];
        return instrument.range_rad_s > 0 || !reached ? instrument.range_rad_s : reached->range_rad_s;
    }
};

struct SurveyedLog {
    std::string name;    ///< the file's
    std::string format;
    std::vector<std::string> remarks;
    std::vector<std::string> problems;  ///< the first ones
    std::uint64_t refused = 0;          ///< records; how many problems there were
    Statistics statistics;
    std::vector<Selection> selections;
    std::int64_t first_ns = 0;  ///< over all its instruments
    std::int64_t last_ns = 0;
};

/// What one reading of all logs shows. Holds at most 64 MB of samples: stretches of 20 s, all of them or every second, fourth … one.
struct Survey {
    std::vector<std::filesystem::path> files;
    LogOptions options;
    std::vector<SurveyedLog> logs;
    std::vector<SurveyedInstrument> instruments;
    std::vector<std::size_t> compared;  ///< the instruments that show the same motion at full rate, at most max_triads
    std::vector<std::string> remarks;   ///< on that choice
    bool one_epoch = false;             ///< the logs' clocks show the same time
};

inline constexpr double window_s = 20.0;  ///< length of a stretch

/// Is called with the share that is done, 0 .. 1.
using Progress = std::function<void(double)>;

/// Reads all logs once.
/// @returns an error as open_instruments does, or if no log holds a gyro.
tl::expected<Survey, std::string> survey(std::span<const std::filesystem::path> files, const LogOptions& options, const Progress& progress = {});

/// Ties the clocks of the compared instruments to that of the first one, by the motion they show; decides whose samples are to be placed on a
/// clock of their own. The kept stretches have served then, and their memory is released.
/// @returns an error if logs that do not share a clock show no common motion.
tl::expected<void, std::string> tie_clocks(Survey& survey);

}  // namespace quorient::recording
