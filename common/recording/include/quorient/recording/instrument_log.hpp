#pragma once

#include "quorient/recording/reader.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::recording {

/// What the stamps of an instrument are of.
enum class StampKind {
    sampling,  ///< the instant that a sample was taken, by the clock of the device that took it
    arrival,   ///< when a host received the sample, or nobody knows: may be late
};

/// A triad of gyros in a log, with the name that the log gives it: g0, IMU1, IMU[2], sensor_gyro.1.
struct Instrument {
    std::string name;
    std::string source;  ///< the message, topic or table that its samples come from; instruments of one source belong together
    StampKind stamps = StampKind::arrival;
    std::uint64_t device = 0;                 ///< the driver's number for it, 0 = not logged
    double range_rad_s = 0;                   ///< largest rate, 0 = not stated
    std::array<std::array<double, 3>, 3> axis{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< where x, y, z point by the device's data sheet
};

/// Most instruments of one log.
inline constexpr std::size_t max_instruments = 32;

inline constexpr double not_logged = std::numeric_limits<double>::quiet_NaN();

/// What one instrument measured once. Times are the log's own, not shifted to its beginning.
struct InstrumentSample {
    std::size_t instrument = 0;  ///< place in InstrumentLog::instruments()
    std::int64_t time_ns = 0;    ///< stamp: of the sample, and the end of what it covers
    double covered_s = 0;        ///< the rates are means over so long before the stamp; 0 = not logged, they hold since the sample before
    std::array<double, 3> rate_rad_s{not_logged, not_logged, not_logged};         ///< not finite = this axis has no value
    std::array<double, 3> acceleration_m_s2{not_logged, not_logged, not_logged};  ///< specific force, where the log has it
    double temperature_c = not_logged;
    std::optional<std::uint8_t> clipped;   ///< bit k: axis k was at its end, by the log itself; nothing = the log has no such field
    std::optional<std::uint64_t> counter;  ///< the instrument's own number of this sample
    std::uint64_t position = 0;            ///< byte offset (binary) or line (text) of the record
};

/// From this time on the vehicle flew by this instrument.
struct Selection {
    std::int64_t time_ns = 0;
    std::uint64_t device = 0;
};

enum class RateUnit { rad_s, deg_s, mdeg_s, mrad_s };
enum class TimeUnit { s, ms, us, ns };

/// What the user says about a log that does not say it itself. Formats that state their units do not need it.
struct LogOptions {
    std::optional<RateUnit> rate_unit;
    std::optional<double> lsb_per_deg_s;  ///< values are raw counts
    std::optional<TimeUnit> time_unit;

    bool any() const { return rate_unit || lsb_per_deg_s || time_unit; }
};

/// A log as a stream of its instruments' samples: reads forward, holds a bounded buffer whatever the log's length. Instruments come to
/// light as the log names them, so their list may grow while it is read. Samples of one instrument come in the order in which they stand in
/// the log; their times may repeat, step back or leave holes: nothing is mended here.
class InstrumentLog {
public:
    virtual ~InstrumentLog() = default;
    InstrumentLog(const InstrumentLog&) = delete;
    InstrumentLog& operator=(const InstrumentLog&) = delete;

    /// `frame`: the sample is filled. `rejected`: one record was refused, problem() says what and where; go on reading.
    virtual ReadOutcome next(InstrumentSample& sample) = 0;

    /// How much of the stored log has been read, 0 .. 1.
    virtual double progress() const = 0;

    const std::string& format() const { return format_; }  ///< "PX4 ULog"
    const std::vector<Instrument>& instruments() const { return instruments_; }
    const std::vector<Selection>& selections() const { return selections_; }
    const Statistics& statistics() const { return statistics_; }  ///< records = samples seen; frames = samples given out
    const std::string& problem() const { return problem_; }

    /// What a reader should know of how the log was understood: "gyros read as deg/s, since …". Grows while the log is read.
    const std::vector<std::string>& remarks() const { return remarks_; }

protected:
    InstrumentLog() = default;

    /// The place of an instrument by its name and source; a new one is added. Nothing: there are max_instruments already.
    std::optional<std::size_t> place_of(const Instrument& instrument);

    std::string format_;
    std::vector<Instrument> instruments_;
    std::vector<Selection> selections_;
    Statistics statistics_;
    std::string problem_;
    std::vector<std::string> remarks_;
};

/// Opens any log by its content, compressed (.gz, .zst, .lz4) or not.
/// @returns an error with file and position that says what was expected; a known kind that cannot be read is named, with what converts it.
tl::expected<std::unique_ptr<InstrumentLog>, std::string> open_instruments(const std::filesystem::path& file, const LogOptions& options = {});

/// The same of a log in memory. @param name  as messages call it.
tl::expected<std::unique_ptr<InstrumentLog>, std::string> open_instruments(std::vector<std::uint8_t> bytes, const std::string& name,
                                                                           const LogOptions& options = {});

}  // namespace quorient::recording
