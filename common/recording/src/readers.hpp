#pragma once

#include "bytes/input.hpp"
#include "line_source.hpp"
#include "log_clock.hpp"
#include "mimu_packet.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/recording/reader.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace quorient::recording {

/// The MIMU4444 binary. Give it only a file in which intact packets were found.
class MimuReader final : public Reader {
public:
    MimuReader(Input input, std::string file);
    ReadOutcome next(RecordedFrame& frame) override;
    double progress() const { return input_.progress(); }

private:
    bool fill();
    ReadOutcome cut_off();
    ReadOutcome resynchronise();
    ReadOutcome refuse(std::string_view why);
    bool in_time();
    void decode(RecordedFrame& frame);

    Input input_;
    std::string file_;
    mimu::Bytes packet_;        // after fill()
    std::uint64_t record_ = 0;  // offset of the record in hand
    LogClock clock_;
    bool started_ = false;
    bool ended_ = false;
    std::uint16_t number_ = 0;  // number of the previous record
    std::uint32_t ticks_ = 0;
    std::int64_t last_frame_ns_ = 0;
    double interval_s_ = 0;
    std::uint64_t refused_ = 0;  // broken packets since the last one that was in time
};

/// What the two text formats share: lines, cells, the clock, refusals with their line.
class TextReader : public Reader {
public:
    ReadOutcome next(RecordedFrame& frame) final;

protected:
    using Cells = std::span<const std::string_view>;

    TextReader(Input input, const std::filesystem::path& file, std::uint64_t header_line, std::size_t needed_cells, std::int64_t nominal_ns);

    /// One record; nothing = it was taken in and gives no frame.
    virtual std::optional<ReadOutcome> read(Cells cells, RecordedFrame& frame) = 0;

    ReadOutcome refuse(std::uint64_t& reason, std::string_view why);
    ReadOutcome refuse_cell(std::string_view cell);
    ReadOutcome refuse_step(std::int64_t step_ns);

    /// Fills what a good record's place in the log decides, and counts it.
    ReadOutcome give(RecordedFrame& frame, std::int64_t time_ns, double interval_s, std::size_t axis_count);

    /// Seconds or counts to the log's nanoseconds; nothing if the cell is not a finite number.
    static std::optional<std::int64_t> stamp(std::string_view cell, double unit_ns);

    LogClock clock_;
    std::optional<std::int64_t> stamp_ns_;  // time stamp of the previous record

private:
    ReadOutcome end_of_text();

    LineSource lines_;
    std::string file_;
    std::size_t needed_cells_;
    bool ended_ = false;
    std::int64_t last_frame_ns_ = 0;
};

/// The columns of a text log, from its header.
struct DotColumns {
    std::size_t time = 0;
    double time_unit_ns = 1;
    std::int64_t time_wrap_ns = 0;  // 0 = the clock never starts over
    std::array<std::size_t, 3> rate{};
    std::optional<std::array<std::size_t, 3>> acceleration;
    std::size_t needed = 0;  // cells of a complete line
};

/// One Xsens DOT's CSV export: a triad of gyros (deg/s) and accelerometers (m/s^2).
class DotReader final : public TextReader {
public:
    DotReader(Input input, const std::filesystem::path& file, const DotColumns& columns, std::uint64_t header_line, std::int64_t nominal_ns);

private:
    std::optional<ReadOutcome> read(Cells cells, RecordedFrame& frame) override;
    std::optional<bool> read_values(Cells cells, double interval_s, RecordedFrame& frame);

    DotColumns columns_;
};

struct CsvColumns {
    std::size_t time = 0;
    std::vector<std::size_t> increment;
    std::optional<std::array<std::size_t, 4>> truth;
    std::size_t needed = 0;
};

/// Plain CSV: increments of any cluster, with or without the truth.
class CsvReader final : public TextReader {
public:
    CsvReader(Input input, const std::filesystem::path& file, const CsvColumns& columns, std::uint64_t header_line, std::int64_t nominal_ns);

private:
    std::optional<ReadOutcome> read(Cells cells, RecordedFrame& frame) override;
    std::optional<ReadOutcome> refuse_values(Cells cells, RecordedFrame& frame);

    CsvColumns columns_;
};

inline constexpr std::size_t most_columns = 64;

/// The place of this column in a header.
std::optional<std::size_t> column(std::span<const std::string_view> header, std::string_view name);

/// The columns that a header names; nothing if it is another format's header. The error names what is missing.
std::optional<tl::expected<DotColumns, std::string>> dot_columns(std::span<const std::string_view> header);
std::optional<tl::expected<CsvColumns, std::string>> csv_columns(std::span<const std::string_view> header);

}  // namespace quorient::recording
