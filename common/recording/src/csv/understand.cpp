// How a table says, or shows, what it holds: its header, decimal commas, units of time and of rate.

#include "csv_log.hpp"
#include "median.hpp"
#include "readers.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::recording::csv {
namespace {

constexpr std::size_t header_lines = 50;  // exports begin with lines about the device
constexpr std::size_t looked_at_rows = 2000;  // rows from which times and decimal commas are recognised
constexpr std::size_t judged_at_once = 5000;
constexpr double slowest_hz = 4;  // that a gyro is logged at; 1000 times as much is the fastest, so that one unit of time fits
constexpr double gravity_m_s2 = 9.80665;

std::string_view word_of_time(std::int64_t unit_ns)
{
    if (unit_ns == 1'000'000'000) return "s";
    if (unit_ns == 1'000'000) return "ms";
    return unit_ns == 1'000 ? "us" : "ns";
}

std::int64_t in_ns(TimeUnit unit)
{
    switch (unit) {
        case TimeUnit::s: return 1'000'000'000;
        case TimeUnit::ms: return 1'000'000;
        case TimeUnit::us: return 1'000;
        case TimeUnit::ns: break;
    }
    return 1;
}

/// The unit in which this step is that of a gyro: 0.25 ms to 250 ms.
std::optional<std::int64_t> unit_of_step(double step)
{
    for (const std::int64_t unit_ns : {1'000'000'000, 1'000'000, 1'000, 1}) {
        const double step_s = step * static_cast<double>(unit_ns) * 1e-9;
        if (step_s <= 1 / slowest_hz && step_s > 1e-3 / slowest_hz) return unit_ns;
    }
    return std::nullopt;
}

}  // namespace

/// The first line that names columns of a gyro, by whatever delimiter.
std::optional<std::string> CsvLog::find_header()
{
    std::string trouble = fmt::format(
        "no line among the first {} names the columns of a gyro and of the time. Name them in the first line: time_s,g0x,g0y,g0z,… "
        "or time_ms,id,gx,gy,gz, with units as in gx [deg/s], or time,increment_0,…",
        header_lines);
    std::string_view line;
    for (std::size_t i = 0; i < header_lines && lines_.next(line) == LineSource::Outcome::line; ++i) {
        if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
        header_line_ = lines_.line_number();
        for (const char delimiter : {';', '\t', ',', ' '}) {
            split_cells(line, delimiter, cells_);
            if (cells_.size() < 4) continue;
            const auto layout = read_layout(cells_);
            if (!layout) continue;
            if (!*layout) return layout->error();
            layout_ = **layout;
            dialect_.delimiter = delimiter;
            header_cells_ = cells_.size();
            read_units_row();
            return std::nullopt;
        }
    }
    header_line_ = 1;
    return trouble;
}

/// The line below the names may have their units. They are read as if they stood behind the names.
void CsvLog::read_units_row()
{
    std::vector<std::string> names(cells_.begin(), cells_.end());
    std::string_view line;
    if (lines_.next(line) != LineSource::Outcome::line) return;
    split_cells(line, dialect_.delimiter, cells_);
    if (cells_.size() != names.size()) return;
    std::size_t units = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        std::string_view unit = cells_[i];
        if (unit.empty() || unit == "-") continue;
        if (unit.front() == '[' || unit.front() == '(') unit = unit.substr(1, unit.size() - 2);
        if (cell_number(unit, {.delimiter = dialect_.delimiter, .decimal_comma = true}) || is_iso_time(unit)) return;  // a row of data
        const std::string with_unit = fmt::format("{} [{}]", names[i], unit);
        const ColumnName named = read_column_name(with_unit);
        if (named.unit.empty() && named.unknown_unit.empty()) continue;  // the column is neither a gyro's nor the time
        names[i] = with_unit;
        ++units;
    }
    const std::vector<std::string_view> header(names.begin(), names.end());
    const auto layout = read_layout(header);
    if (units < 3 || !layout || !*layout) return;
    layout_ = **layout;
    header_line_ = lines_.line_number();
}

std::optional<std::string> CsvLog::understand()
{
    if (auto problem = apply_options()) return problem;
    if (auto problem = look_at_numbers(looked_at_rows)) return problem;
    if (auto problem = judge_times(looked_at_rows)) return problem;
    judge_accelerations();
    return judge_rates();
}

/// What the user says goes before what the header says.
std::optional<std::string> CsvLog::apply_options()
{
    if (options_.rate_unit && options_.lsb_per_deg_s) return "--unit and --lsb-per-deg-s contradict each other";
    for (GyroColumns& gyro : layout_.gyros) {
        if (!gyro.unknown_unit.empty() && !options_.rate_unit && !options_.lsb_per_deg_s)
            return fmt::format("the header names '{}' as the gyros' unit, and known are rad/s, deg/s, mrad/s and mdeg/s: give --unit, or "
                               "--lsb-per-deg-s for raw counts",
                               gyro.unknown_unit);
        if (options_.time_unit && !gyro.time_fraction) gyro.time_unit_ns = in_ns(*options_.time_unit);
        if (!options_.rate_unit && !options_.lsb_per_deg_s) continue;
        const double factor = options_.rate_unit ? factor_of(*options_.rate_unit) : degree / *options_.lsb_per_deg_s;
        if (gyro.factor[0] > 0 && std::abs(gyro.factor[0] / factor - 1) > 1e-9)
            remarks_.push_back(fmt::format("{}: the header names another unit than the one that was asked for", gyro.name));
        gyro.factor.fill(factor);
    }
    return std::nullopt;
}

/// Whether numbers have decimal commas. Then a comma cannot part cells.
std::optional<std::string> CsvLog::look_at_numbers(std::size_t rows)
{
    to_first_row();
    std::size_t too_wide = 0;
    std::size_t seen = 0;
    for (; seen < rows && !dialect_.decimal_comma && next_row(); ++seen) {
        too_wide += cells_.size() > header_cells_ + 1 ? 1 : 0;
        if (dialect_.delimiter == ',') continue;
        for (const GyroColumns& gyro : layout_.gyros) {
            const std::string_view value = cell(gyro.value[0]);
            dialect_.decimal_comma = dialect_.decimal_comma || (value.find(',') != std::string_view::npos && !number(value));
        }
    }
    if (2 * too_wide > seen)
        return fmt::format("{} columns are named, and most rows have more cells: with decimal commas, cells must be parted by ; or tabs",
                           header_cells_);
    if (dialect_.decimal_comma) look_at_points(rows);
    return std::nullopt;
}

/// Whether points stand between thousands: some cell shows it, and none contradicts.
void CsvLog::look_at_points(std::size_t rows)
{
    to_first_row();
    bool shown = false;
    bool contradicted = false;
    const auto look = [&](std::string_view cell) {
        const Points points = points_of(cell);
        shown = shown || points == Points::thousands;
        contradicted = contradicted || points == Points::decimal;
    };
    for (std::size_t seen = 0; seen < rows && next_row(); ++seen)
        for (const GyroColumns& gyro : layout_.gyros) {
            look(cell(gyro.time));
            for (const std::size_t place : gyro.value) look(cell(place));
        }
    dialect_.point_thousands = shown && !contradicted;
}

/// The unit of the time and of the increments' intervals, from the usual step of one instrument.
std::optional<std::string> CsvLog::judge_times(std::size_t rows)
{
    for (GyroColumns& gyro : layout_.gyros) {
        to_first_row();
        std::map<std::string, double, std::less<>> before;
        std::vector<double> steps;
        std::vector<double> intervals;
        bool dates = false;
        for (std::size_t i = 0; i < rows && next_row(); ++i) {
            if (gyro.time_unit_ns == 0 && is_iso_time(cell(gyro.time))) dates = true;
            if (is_time_of_day(cell(gyro.time))) gyro.of_day = true;
            const auto time_ns = dates || gyro.time_unit_ns > 0 ? time_of(gyro) : std::nullopt;
            const auto plain = time_ns ? std::optional(static_cast<double>(*time_ns)) : cell_number(cell(gyro.time), dialect_);
            if (!plain || !std::isfinite(*plain)) continue;
            const auto key = layout_.identity ? cell(*layout_.identity) : std::string_view{};
            const auto found = before.find(key);
            if (found != before.end() && *plain > found->second) steps.push_back(*plain - found->second);
            if (found != before.end()) found->second = *plain;
            else if (before.size() < max_instruments) before.emplace(key, *plain);
            if (gyro.interval) intervals.push_back(cell_number(cell(*gyro.interval), dialect_).value_or(not_logged));
        }
        std::erase_if(intervals, [](double interval) { return !(interval > 0); });
        if (steps.empty()) return fmt::format("no two of the {} rows that follow have times one after the other", rows);
        const double step = median(steps);
        if (dates) gyro.time_unit_ns = 1;  // any will do: the cells are dates
        if (gyro.time_unit_ns == 0) {
            const auto unit_ns = unit_of_step(step);
            if (!unit_ns) return fmt::format("the time steps by {:.6g}, which is no gyro's step in s, ms, us or ns: say --time-unit", step);
            gyro.time_unit_ns = *unit_ns;
            const std::string remark = fmt::format("time read as {}, since its usual step is {}", word_of_time(*unit_ns),
                                                   step < 1000 ? fmt::format("{:.6g}", step) : fmt::format("{:.0f}", step));
            if (std::find(remarks_.begin(), remarks_.end(), remark) == remarks_.end()) remarks_.push_back(remark);
        }
        if (gyro.interval && gyro.interval_factor == 0 && !intervals.empty()) {
            const auto unit_ns = unit_of_step(median(intervals));
            if (!unit_ns) return "the unit of the increments' intervals is not known: name it in the header, as in dt_s";
            gyro.interval_factor = static_cast<double>(*unit_ns) * 1e-9;
        }
    }
    return std::nullopt;
}

/// Specific force is that of gravity most of the time; an unknown unit in which it is not is left out.
void CsvLog::judge_accelerations()
{
    for (GyroColumns& gyro : layout_.gyros) {
        if (!gyro.acceleration || gyro.acceleration_factor > 0) continue;
        to_first_row();
        std::vector<double> sizes;
        while (sizes.size() < looked_at_rows && next_row()) {
            std::array<double, 3> force{};
            for (std::size_t k = 0; k < 3; ++k)
                force[k] = cell_number(cell((*gyro.acceleration)[k]), dialect_).value_or(not_logged);
            const double size = std::hypot(force[0], force[1], force[2]);
            if (std::isfinite(size)) sizes.push_back(size);
        }
        if (sizes.empty()) continue;
        const double usual = median(sizes);
        if (usual > 0.7 && usual < 1.4) gyro.acceleration_factor = gravity_m_s2;
        else if (usual > 0.7 * gravity_m_s2 && usual < 1.4 * gravity_m_s2) gyro.acceleration_factor = 1;
        else remarks_.push_back(fmt::format("accelerometers left out: they usually read {:.4g}, which is gravity neither in g nor in m/s^2", usual));
    }
}

/// The unit of rates where the header does not name it: read on until the values show it.
std::optional<std::string> CsvLog::judge_rates()
{
    const auto unknown = [](const GyroColumns& gyro) { return !(gyro.factor[0] > 0); };
    if (std::none_of(layout_.gyros.begin(), layout_.gyros.end(), unknown)) return doubt_stated_unit(), std::nullopt;
    to_first_row();
    std::vector<double> stated(layout_.gyros.size());
    for (std::size_t i = 0; i < layout_.gyros.size(); ++i)
        if (unknown(layout_.gyros[i])) layout_.gyros[i].factor.fill(1.0), stated[i] = 1;
    std::vector<RateJudge> judges(max_instruments);
    std::vector<std::int64_t> before(max_instruments);
    InstrumentSample sample;
    RateJudge::Verdict verdict;
    std::size_t samples = 0;
    std::size_t judge = 0;
    for (auto outcome = next(sample); outcome != ReadOutcome::end; outcome = next(sample)) {
        if (outcome == ReadOutcome::rejected) continue;
        const std::size_t number = layout_.identity ? 0 : next_gyro_ - 1;
        if (stated[number] == 0) continue;
        judge = sample.instrument;
        const double interval_s = static_cast<double>(sample.time_ns - before[judge]) * 1e-9;
        before[judge] = sample.time_ns;
        std::array<double, 3> force = sample.acceleration_m_s2;
        judges[judge].add(interval_s, sample.rate_rad_s, force);
        if (++samples % judged_at_once == 0 && (verdict = judges[judge].verdict()).unit) break;
        if (samples % judged_at_once == 0 && judges[judge].looks_like_counts()) break;
    }
    if (!verdict.unit) verdict = judges[judge].verdict();
    if (!verdict.unit) return fmt::format("the header does not name the gyros' unit; {}", verdict.reason);
    for (std::size_t i = 0; i < layout_.gyros.size(); ++i)
        if (stated[i] > 0) layout_.gyros[i].factor.fill(factor_of(*verdict.unit));
    remarks_.push_back(fmt::format("gyros read as {}, since {}", word_of(*verdict.unit), verdict.reason));
    return std::nullopt;
}

/// A unit that is stated may still be wrong: gravity that turns with the body shows it.
void CsvLog::doubt_stated_unit()
{
    const GyroColumns& gyro = layout_.gyros.front();
    if (!gyro.acceleration || gyro.increments) return;
    to_first_row();
    RateJudge judge;
    std::optional<std::int64_t> before_ns;
    std::optional<std::size_t> first;
    InstrumentSample sample;
    for (std::size_t rows = 0; rows < judged_at_once && next_row(); ++rows) {
        if (read(0, sample) != ReadOutcome::frame || sample.instrument != first.value_or(sample.instrument)) continue;
        first = sample.instrument;
        const double interval_s = before_ns ? static_cast<double>(sample.time_ns - *before_ns) * 1e-9 : 0;
        before_ns = sample.time_ns;
        judge.add(interval_s, sample.rate_rad_s, sample.acceleration_m_s2);
    }
    if (const auto times = judge.times_of_gravity(); times && (*times > 10 || *times < 0.1))
        remarks_.push_back(fmt::format(
            "the gyros' unit may be wrong: gravity turns {:.3g} times as far as their rates say; --unit overrides the header", *times));
}

}  // namespace quorient::recording::csv
