#include "dataflash_log.hpp"

#include "readers.hpp"

#include <fmt/format.h>

namespace quorient::recording::dataflash {
namespace {

constexpr std::size_t most_cells = 32;  // 16 fields are the most that a format has

/// A text log whose IMU messages have no FMTU line states its values in rad/s.
const Units& usual_units()
{
    static const Units units;
    return units;
}

}  // namespace

bool is_text(Bytes beginning)
{
    const std::string_view text(reinterpret_cast<const char*>(beginning.data()), beginning.size());
    const std::size_t place = text.find("FMT, 128, 89, FMT");
    return place != std::string_view::npos && (place == 0 || text[place - 1] == '\n');
}

TextLog::TextLog(Input input, std::string name) : lines_(std::move(input)), name_(std::move(name))
{
    format_ = "ArduPilot DataFlash, text";
}

ReadOutcome TextLog::next(InstrumentSample& sample)
{
    for (;;) {
        std::string_view line;
        const auto found = lines_.next(line);
        if (found == LineSource::Outcome::end) break;
        if (found == LineSource::Outcome::too_long) continue;
        std::array<std::string_view, most_cells> cells;
        const std::size_t count = std::min(split(line, cells), cells.size());
        if (count == 0) continue;
        if (const auto outcome = read(std::span(cells).first(count), sample)) return *outcome;
    }
    if (ended_ || lines_.trouble().empty()) return ReadOutcome::end;
    ended_ = true;
    return refuse(lines_.trouble());
}

ReadOutcome TextLog::refuse(std::string_view why)
{
    problem_ = fmt::format("{}:{}: {}", name_, lines_.line_number(), why);
    return ReadOutcome::rejected;
}

void TextLog::read_format(std::span<const std::string_view> cells)
{
    constexpr std::size_t first_label = 5;
    if (cells.size() <= first_label || !is_imu_name(cells[3])) return;
    std::string labels;
    for (const std::string_view label : cells.subspan(first_label)) labels += fmt::format("{},", label);
    labels.pop_back();
    const auto fields = imu_message(make_format(0, 0, cells[3], cells[4], labels), usual_units());
    if (!fields) return;
    messages_.insert_or_assign(std::string(cells[3]), Message{*fields, cells.size() - first_label + 1, fields->stamps});
}

std::optional<ReadOutcome> TextLog::read(std::span<const std::string_view> cells, InstrumentSample& sample)
{
    if (cells[0] == "FMT") {
        read_format(cells);
        return std::nullopt;
    }
    const auto found = messages_.find(cells[0]);
    if (found == messages_.end()) return std::nullopt;
    const Message& message = found->second;
    ++statistics_.records;
    std::optional<std::string_view> bad;
    const auto value = [&](std::size_t place) {
        const auto read = number(cells[place + 1]);
        if (!read && !bad) bad = cells[place + 1];
        return read.value_or(0.0);
    };
    const auto made = cells.size() < message.needed ? std::nullopt : sample_of(message.fields, value);
    if (!made || bad) {
        ++statistics_.malformed;
        return refuse(bad ? fmt::format("'{}' is not a number", bad->substr(0, 40)) : fmt::format("{}: cells are missing", cells[0]));
    }
    Instrument instrument;
    instrument.source = source_name(cells[0]);
    instrument.name =
        instrument_name(found->first, message.fields.instance ? std::optional(value(*message.fields.instance)) : std::nullopt);
    instrument.stamps = message.stamps;
    const auto place = place_of(instrument);
    if (!place) {
        ++statistics_.malformed;
        return refuse(fmt::format("more than {} instruments", max_instruments));
    }
    sample = *made;
    sample.instrument = *place;
    sample.position = lines_.line_number();
    ++statistics_.frames;
    return ReadOutcome::frame;
}

}  // namespace quorient::recording::dataflash
