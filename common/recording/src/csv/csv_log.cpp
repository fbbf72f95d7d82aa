#include "csv_log.hpp"

#include "quorient/messages/sample_time.hpp"
#include "readers.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace quorient::recording::csv {

CsvLog::CsvLog(Input input, std::string name, const LogOptions& options)
    : lines_(std::move(input)), name_(std::move(name)), options_(options)
{
    format_ = "CSV";
}

tl::expected<std::unique_ptr<InstrumentLog>, std::string> CsvLog::open(Input input, std::string name, const LogOptions& options)
{
    std::unique_ptr<CsvLog> log(new CsvLog(std::move(input), std::move(name), options));
    for (const auto step : {&CsvLog::find_header, &CsvLog::understand})
        if (const auto problem = (log.get()->*step)()) return tl::unexpected(fmt::format("{}:{}: {}", log->name_, log->header_line_, *problem));
    log->to_first_row();
    log->statistics_ = {};
    return log;
}

void CsvLog::to_first_row()
{
    lines_.rewind();
    std::string_view line;
    while (lines_.line_number() < header_line_ && lines_.next(line) != LineSource::Outcome::end) {
    }
    cells_.clear();
    gyros_.clear();
    of_columns_.clear();
    instruments_.clear();
    next_gyro_ = layout_.gyros.size();
    ended_ = false;
}

/// Takes the next line that holds a row. @returns false at the end.
bool CsvLog::next_row()
{
    for (;;) {
        std::string_view line;
        const auto outcome = lines_.next(line);
        if (outcome == LineSource::Outcome::end) return false;
        if (outcome == LineSource::Outcome::too_long) line = {};
        const std::string_view text = trimmed(line);
        if (outcome == LineSource::Outcome::line && (text.empty() || text.front() == '#' || text.front() == '%')) continue;
        split_cells(line, dialect_.delimiter, cells_);
        next_gyro_ = 0;
        timed_ = nullptr;
        return true;
    }
}

ReadOutcome CsvLog::next(InstrumentSample& sample)
{
    for (;;) {
        while (next_gyro_ >= layout_.gyros.size()) {
            if (next_row()) {
                if (cells_.size() >= layout_.needed) break;
                ++statistics_.records;
                ++statistics_.malformed;
                next_gyro_ = layout_.gyros.size();
                return refuse(fmt::format("{} cells, at least {} are needed", cells_.size(), layout_.needed));
            }
            if (ended_ || lines_.trouble().empty()) return ReadOutcome::end;
            ended_ = true;
            return refuse(lines_.trouble());
        }
        if (const auto outcome = read(next_gyro_++, sample)) return *outcome;
    }
}

ReadOutcome CsvLog::refuse(std::string_view why)
{
    problem_ = fmt::format("{}:{}: {}", name_, lines_.line_number(), why);
    return ReadOutcome::rejected;
}

std::optional<std::int64_t> CsvLog::time_of(const GyroColumns& gyro) const
{
    auto time_ns = cell_time_ns(cell(gyro.time), std::max<std::int64_t>(1, gyro.time_unit_ns), dialect_);
    if (!time_ns || !gyro.time_fraction) return time_ns;
    const auto fraction_ns = cell_time_ns(cell(*gyro.time_fraction), 1, dialect_);
    if (!fraction_ns) return std::nullopt;
    return *time_ns + std::clamp<std::int64_t>(*fraction_ns, 0, 1'000'000'000);
}

/// The time of the row in hand. Its gyros mostly share one column, which is read once.
std::optional<std::int64_t> CsvLog::row_time_of(const GyroColumns& gyro)
{
    const auto clock_of = [](const GyroColumns& of) { return std::tie(of.time, of.time_fraction, of.time_unit_ns); };
    if (timed_ == nullptr || clock_of(*timed_) != clock_of(gyro)) row_time_ns_ = time_of(gyro);
    timed_ = &gyro;
    return row_time_ns_;
}

/// One instrument's part of a row; nothing = it has none in this row.
std::optional<ReadOutcome> CsvLog::read(std::size_t number, InstrumentSample& sample)
{
    const GyroColumns& gyro = layout_.gyros[number];
    std::array<double, 3> raw{};
    sample = {};
    const bool empty = std::all_of(gyro.value.begin(), gyro.value.end(), [&](std::size_t place) { return cell(place).empty(); });
    if (empty) return std::nullopt;
    ++statistics_.records;
    if (const auto refused = read_values(gyro, sample, raw)) return refused;
    const auto time_ns = row_time_of(gyro);
    if (!time_ns) {
        ++statistics_.malformed;
        return refuse(fmt::format("'{}' is not a time", cell(gyro.time).substr(0, 40)));
    }
    Gyro* const state = gyro_state(number);
    if (state == nullptr) {
        ++statistics_.malformed;
        return refuse(fmt::format("more than {} instruments", max_instruments));
    }
    sample.instrument = state->place;
    constexpr std::int64_t wrap_ns = 4'294'967'296'000;  // a 32-bit count of microseconds
    constexpr std::int64_t day_ns = 86'400'000'000'000;
    const std::int64_t turn_ns = gyro.time_wraps ? wrap_ns : gyro.of_day ? day_ns : 0;
    const bool turned = turn_ns > 0 && state->stamp_ns && *time_ns < *state->stamp_ns - turn_ns / 2;
    const std::int64_t wraps_ns = state->wraps_ns + (turned ? turn_ns : 0);
    if (!is_sample_time(*time_ns) || !is_sample_time(*time_ns + wraps_ns)) {
        ++statistics_.malformed;
        return refuse("a time that is centuries away");
    }
    state->wraps_ns = wraps_ns;
    const std::int64_t step_ns = state->stamp_ns ? *time_ns - *state->stamp_ns : 0;
    state->stamp_ns = *time_ns;
    sample.time_ns = *time_ns + state->wraps_ns;
    sample.position = lines_.line_number();
    if (gyro.increments) {
        const double stated_s = gyro.interval ? sample.covered_s : 0;
        const double covered_s = stated_s > 0 ? stated_s : static_cast<double>(step_ns) * 1e-9;
        if (!(covered_s > 0) || !std::isfinite(covered_s))
            return std::nullopt;  // the first increment of a log stands for an interval that nothing states
        sample.covered_s = covered_s;
        for (std::size_t k = 0; k < 3; ++k) sample.rate_rad_s[k] = raw[k] / covered_s;
    }
    ++statistics_.frames;
    return ReadOutcome::frame;
}

/// @param raw  rates, or increments, in rad
std::optional<ReadOutcome> CsvLog::read_values(const GyroColumns& gyro, InstrumentSample& sample, std::array<double, 3>& raw)
{
    const auto read = [&](std::size_t place, double factor, double& value) {
        const auto number = cell_number(cell(place), dialect_);
        if (number) value = *number * factor;
        return number.has_value();
    };
    std::optional<std::size_t> bad;
    for (std::size_t k = 0; k < 3; ++k) {
        if (!read(gyro.value[k], gyro.factor[k], raw[k])) bad = gyro.value[k];
        sample.rate_rad_s[k] = raw[k];
        if (gyro.acceleration && gyro.acceleration_factor > 0 && (*gyro.acceleration)[k] < cells_.size())
            read((*gyro.acceleration)[k], gyro.acceleration_factor, sample.acceleration_m_s2[k]);
    }
    if (gyro.interval && !read(*gyro.interval, gyro.interval_factor, sample.covered_s)) bad = *gyro.interval;
    if (gyro.temperature) read(*gyro.temperature, 1.0, sample.temperature_c);
    double counter = not_logged;
    if (gyro.counter && read(*gyro.counter, 1.0, counter) && counter >= 0 && counter < 9e15)
        sample.counter = static_cast<std::uint64_t>(counter);
    if (!bad) return std::nullopt;
    ++statistics_.malformed;
    return refuse(fmt::format("'{}' is not a number", cell(*bad).substr(0, 40)));
}

CsvLog::Gyro* CsvLog::gyro_state(std::size_t number)
{
    if (layout_.identity) return gyro_named(cell(*layout_.identity).substr(0, 64), number);
    if (of_columns_.size() <= number) of_columns_.resize(number + 1);
    if (of_columns_[number] == nullptr) of_columns_[number] = gyro_named(layout_.gyros[number].name, number);
    return of_columns_[number];
}

CsvLog::Gyro* CsvLog::gyro_named(std::string_view key, std::size_t number)
{
    const auto found = gyros_.find(key);
    if (found != gyros_.end()) return found->second.known ? &found->second : nullptr;
    if (gyros_.size() >= max_instruments) return nullptr;
    Instrument made;
    const bool only_digits = key.find_first_not_of("0123456789") == std::string_view::npos;
    made.name = layout_.identity && only_digits ? fmt::format("{}{}", layout_.identity_name, key) : std::string(key);
    if (made.name.empty()) made.name = name_.substr(0, name_.find('.'));
    made.source = name_;
    made.stamps = layout_.gyros[number].time_wraps ? StampKind::sampling : StampKind::arrival;
    const auto place = place_of(made);
    return &gyros_.emplace(std::string(key), Gyro{place.value_or(0), {}, 0, place.has_value()}).first->second;
}

}  // namespace quorient::recording::csv
