#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/limits.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

namespace quorient::recording {

/// One sample of a log, in the units of the pipeline.
struct RecordedFrame {
    std::int64_t time_ns = 0;                  ///< end of the interval, from the beginning of the log's first frame; strictly increasing
    double interval_s = 0;                     ///< time that this sample's increments stand for (without the gap before it)
    std::array<double, max_axes> increment{};  ///< gyros: rate x interval [rad]
    std::array<double, max_axes> acceleration_m_s2{};  ///< accelerometer axes, placed as the gyros'; 0 where the log has none
    AxisMask valid_mask = 0;                           ///< gyro axes with a value
    AxisMask acceleration_mask = 0;
    std::optional<std::array<double, 4>> truth;  ///< q_RB at the end of the interval (w,x,y,z)
    std::uint64_t lost_before = 0;               ///< samples missing or refused between the previous frame and this one
    std::uint64_t position = 0;                  ///< byte offset (binary) or line (text) of the record
    std::size_t axis_count = 0;
};

/// Counts of what a reader has read so far. Each refused record is counted once, under its reason.
struct Statistics {
    std::uint64_t records = 0;  ///< complete records seen: packets or data lines, refused ones included
    std::uint64_t frames = 0;   ///< given out
    std::uint64_t checksum_failures = 0;
    std::uint64_t malformed = 0;        ///< a line with a bad or missing cell, a line too long
    std::uint64_t lost = 0;             ///< records missing by the log's numbers or times
    std::uint64_t nan = 0;              ///< records with NaN or infinity
    std::uint64_t incomplete = 0;       ///< frames given out without one axis or more (not valid there)
    std::uint64_t repeated = 0;         ///< records with the time stamp or number of the one before
    std::uint64_t irregular = 0;        ///< records whose time step fits no whole number of intervals, or goes back
    std::uint64_t skipped_bytes = 0;    ///< passed over to find the next intact packet
    std::uint64_t truncated_bytes = 0;  ///< at the end, belonging to a record that was cut
    std::int64_t duration_ns = 0;       ///< from the first to the last record
};

enum class ReadOutcome {
    frame,     ///< the frame is filled
    rejected,  ///< one record was refused: problem() says what and where; go on reading
    end,
};

/// A log as a stream: reads forward, holds a fixed buffer whatever the log's length.
class Reader {
public:
    virtual ~Reader() = default;
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    virtual ReadOutcome next(RecordedFrame& frame) = 0;

    /// Nominal axes, instruments and their names, range, quantum and interval; sigma and bias are 0 (see rest_statistics).
    /// A plain CSV does not say where its axes point: they are 0 there.
    const ClusterDescription& description() const { return description_; }

    const Statistics& statistics() const { return statistics_; }

    /// The latest refusal: file, byte offset or line, what is wrong.
    const std::string& problem() const { return problem_; }

protected:
    Reader() = default;

    ClusterDescription description_;
    Statistics statistics_;
    std::string problem_;
};

/// Opens a log by its content: MIMU4444 binary, Xsens DOT CSV, plain CSV as `quorient simulate` writes it; or any log of instruments
/// (instrument_log.hpp), which are put on common intervals.
/// @returns an error with file and position if nothing in the log's beginning can be read as any of them.
tl::expected<std::unique_ptr<Reader>, std::string> open_log(const std::filesystem::path& file);

/// One line for an operator: counts that are not 0.
std::string summary(const Statistics& statistics);

}  // namespace quorient::recording
