#include "csv/csv_log.hpp"
#include "dataflash/dataflash_log.hpp"
#include "mcap/frame_reader.hpp"
#include "mcap/mcap_log.hpp"
#include "require.hpp"
#include "ros/sqlite_bag.hpp"
#include "targets.hpp"
#include "ulog/ulog_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace quorient::fuzz {

namespace {

using recording::Input;
using recording::InstrumentLog;
using recording::InstrumentSample;
using recording::ReadOutcome;

constexpr double longest_time_ns = 4.7e18;
constexpr std::size_t most_from_chunks = 4096;  // bytes that a compressed one may become

Input input_of(const std::uint8_t* data, std::size_t size)
{
    return Input(recording::memory_source(std::vector<std::uint8_t>(data, data + size)));
}

/// Reads a log to its end, whatever is in it.
void read_all(InstrumentLog& log, std::size_t size)
{
    InstrumentSample sample;
    // Each record gives at most one refusal, or 32 samples of some bytes each.
    for (std::size_t calls = 0;; ++calls) {
        REQUIRE(calls <= 64 + 64 * size);
        const auto outcome = log.next(sample);
        if (outcome == ReadOutcome::end) break;
        REQUIRE(log.progress() >= 0 && log.progress() <= 1);
        REQUIRE(log.instruments().size() <= recording::max_instruments);
        if (outcome == ReadOutcome::rejected) {
            REQUIRE(!log.problem().empty());
            continue;
        }
        REQUIRE(sample.instrument < log.instruments().size());
        REQUIRE(std::abs(static_cast<double>(sample.time_ns)) < longest_time_ns);
        REQUIRE(sample.covered_s >= 0 && std::isfinite(sample.covered_s));
    }
    REQUIRE(log.next(sample) == ReadOutcome::end);
    REQUIRE(log.statistics().skipped_bytes <= size);
}

/// Reads the frames of a record to its end, whatever is in it.
void read_frames(recording::Reader& reader, std::size_t size)
{
    recording::RecordedFrame frame;
    std::int64_t before_ns = std::numeric_limits<std::int64_t>::min();
    for (std::size_t calls = 0;; ++calls) {
        REQUIRE(calls <= 64 + 64 * size);
        const auto outcome = reader.next(frame);
        if (outcome == ReadOutcome::end) break;
        if (outcome == ReadOutcome::rejected) {
            REQUIRE(!reader.problem().empty());
            continue;
        }
        REQUIRE(frame.axis_count == reader.description().axis_count && frame.axis_count <= max_axes);
        REQUIRE(frame.time_ns > before_ns && frame.interval_s > 0 && frame.valid_mask != 0);
        REQUIRE(static_cast<double>(frame.lost_before) * frame.interval_s <= 3600);
        for (std::size_t axis = 0; axis < frame.axis_count; ++axis) REQUIRE(std::isfinite(frame.increment[axis]));
        before_ns = frame.time_ns;
    }
    REQUIRE(reader.next(frame) == ReadOutcome::end);
}

/// What an opener gives: a log, or words.
void read_opened(tl::expected<std::unique_ptr<InstrumentLog>, std::string> log, std::size_t size)
{
    if (log) read_all(**log, size);
    else REQUIRE(!log.error().empty());
}

}  // namespace

void dataflash(const std::uint8_t* data, std::size_t size)
{
    recording::dataflash::BinaryLog binary(input_of(data, size), "fuzz");
    read_all(binary, size);
    recording::dataflash::TextLog text(input_of(data, size), "fuzz");
    read_all(text, size);
}

void ulog(const std::uint8_t* data, std::size_t size)
{
    read_opened(recording::ulog::UlogLog::open(input_of(data, size), "fuzz"), size);
}

void csv(const std::uint8_t* data, std::size_t size)
{
    if (size == 0) return;
    recording::LogOptions options;
    if (data[0] % 3 == 1) options.rate_unit = recording::RateUnit::deg_s;
    if (data[0] % 3 == 2) options.lsb_per_deg_s = 16.4;
    read_opened(recording::csv::CsvLog::open(input_of(data + 1, size - 1), "fuzz", options), size);
}

void mcap(const std::uint8_t* data, std::size_t size)
{
    recording::mcap::McapLog log(input_of(data, size), "fuzz");
    read_all(log, most_from_chunks * size + 4096);
    Input input = input_of(data, size);
    const auto record = recording::mcap::FrameReader::open(input, "fuzz");
    if (!record) return;
    if (*record) read_frames(***record, most_from_chunks * size + 4096);
    else REQUIRE(!record->error().empty());
}

void sqlite(const std::uint8_t* data, std::size_t size)
{
    read_opened(recording::ros::SqliteBag::open(std::vector<std::uint8_t>(data, data + size), "fuzz"), size + 4096);
}

void logs(const std::uint8_t* data, std::size_t size)
{
    read_opened(recording::open_instruments(std::vector<std::uint8_t>(data, data + size), "fuzz"), most_from_chunks * size + 4096);
}

}  // namespace quorient::fuzz
