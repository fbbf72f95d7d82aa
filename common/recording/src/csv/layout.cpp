#include "layout.hpp"

#include "readers.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>

namespace quorient::recording::csv {
namespace {

using Columns = std::vector<ColumnName>;

/// Columns of one quantity and owner, by axis.
using Axes = std::map<std::size_t, std::size_t>;

std::map<std::string, Axes> by_owner(const Columns& columns, Quantity quantity, bool bare)
{
    std::map<std::string, Axes> found;
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i].quantity == quantity && columns[i].axis && columns[i].bare == bare) found[columns[i].owner].emplace(*columns[i].axis, i);
    return found;
}

std::optional<std::array<std::size_t, 3>> triple(const Axes& axes, std::size_t first)
{
    std::array<std::size_t, 3> places{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto found = axes.find(first + k);
        if (found == axes.end()) return std::nullopt;
        places[k] = found->second;
    }
    return places;
}

/// The best column of a quantity: of this owner, else the only or the best one of nobody's or anybody's.
std::optional<std::size_t> column_for(const Columns& columns, Quantity quantity, std::string_view owner)
{
    std::optional<std::size_t> best;
    const auto worth = [&](std::size_t i) { return (columns[i].owner == owner ? 10 : 0) + columns[i].rank; };
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i].quantity == quantity && (!best || worth(i) > worth(*best))) best = i;
    return best;
}

/// A column of exactly this owner.
std::optional<std::size_t> own_column(const Columns& columns, Quantity quantity, std::string_view owner)
{
    const auto best = column_for(columns, quantity, owner);
    return best && columns[*best].owner == owner ? best : std::nullopt;
}

std::int64_t time_unit_ns(std::string_view unit)
{
    if (unit == "s") return 1'000'000'000;
    if (unit == "ms") return 1'000'000;
    if (unit == "us") return 1'000;
    return unit == "ns" ? 1 : 0;
}

double acceleration_factor(std::string_view unit)
{
    if (unit == "m/s^2") return 1;
    if (unit == "g") return 9.80665;
    return unit == "mg" ? 9.80665e-3 : 0;
}

void set_time(const Columns& columns, std::string_view owner, std::size_t time, GyroColumns& gyro)
{
    gyro.time = time;
    gyro.time_unit_ns = time_unit_ns(columns[time].unit);
    gyro.time_fraction = column_for(columns, Quantity::time_fraction, owner);
    if (gyro.time_fraction) gyro.time_unit_ns = 1'000'000'000;
    gyro.time_wraps = columns[time].text == "SampleTimeFine";
    if (gyro.time_wraps) gyro.time_unit_ns = 1'000;
}

/// Everything of one triad whose three columns are known.
/// @param alone  it is the table's only triad
GyroColumns gyro_of(const Columns& columns, const std::string& owner, const std::array<std::size_t, 3>& value, Quantity quantity,
                    std::size_t time, bool alone)
{
    GyroColumns gyro;
    gyro.value = value;
    gyro.increments = quantity == Quantity::increment;
    gyro.name = common_name({columns[value[0]].text, columns[value[1]].text, columns[value[2]].text});
    for (std::size_t k = 0; k < 3; ++k) gyro.factor[k] = factor_of(columns[value[k]].unit);
    for (const std::size_t place : value)
        if (gyro.unknown_unit.empty()) gyro.unknown_unit = columns[place].unknown_unit;
    // A unit that the header names for one axis is that of all.
    std::replace(gyro.factor.begin(), gyro.factor.end(), 0.0, *std::max_element(gyro.factor.begin(), gyro.factor.end()));
    if (gyro.increments) {
        gyro.interval = column_for(columns, Quantity::interval, owner);
        if (gyro.interval) gyro.interval_factor = static_cast<double>(time_unit_ns(columns[*gyro.interval].unit)) * 1e-9;
    }
    const auto accelerations = by_owner(columns, Quantity::acceleration, false);
    auto acceleration = accelerations.find(owner);
    if (acceleration == accelerations.end() && accelerations.size() == 1 && alone) acceleration = accelerations.begin();
    if (acceleration != accelerations.end()) gyro.acceleration = triple(acceleration->second, 0);
    if (gyro.acceleration) gyro.acceleration_factor = acceleration_factor(columns[(*gyro.acceleration)[0]].unit);
    gyro.temperature = own_column(columns, Quantity::temperature, owner);
    gyro.counter = own_column(columns, Quantity::counter, owner);
    set_time(columns, owner, time, gyro);
    return gyro;
}

/// Quorient's own increments are numbered through: three after three are a triad.
void add_numbered(const Columns& columns, const Axes& axes, std::size_t time, std::vector<GyroColumns>& gyros)
{
    for (std::size_t first = 0; const auto value = triple(axes, first); first += 3) {
        gyros.push_back(gyro_of(columns, "", *value, Quantity::increment, time, axes.size() == 3));
        gyros.back().name = fmt::format("axes {}-{}", first, first + 2);
        gyros.back().factor.fill(1.0);
    }
}

std::size_t needed_cells(const Layout& layout)
{
    std::size_t last = layout.identity.value_or(0);
    for (const GyroColumns& gyro : layout.gyros) {
        last = std::max({last, gyro.time, gyro.value[0], gyro.value[1], gyro.value[2]});
        if (gyro.time_fraction) last = std::max(last, *gyro.time_fraction);
        if (gyro.interval) last = std::max(last, *gyro.interval);
    }
    return last + 1;
}

}  // namespace

double factor_of(std::string_view unit)
{
    if (unit.starts_with("rad")) return 1;
    if (unit.starts_with("deg")) return degree;
    if (unit.starts_with("mdeg")) return 1e-3 * degree;
    return unit.starts_with("mrad") ? 1e-3 : 0;
}

double factor_of(RateUnit unit)
{
    return factor_of(word_of(unit));
}

std::string_view word_of(RateUnit unit)
{
    switch (unit) {
        case RateUnit::rad_s: return "rad/s";
        case RateUnit::deg_s: return "deg/s";
        case RateUnit::mdeg_s: return "mdeg/s";
        case RateUnit::mrad_s: return "mrad/s";
    }
    return "";
}

std::optional<tl::expected<Layout, std::string>> read_layout(std::span<const std::string_view> header)
{
    Columns columns;
    for (const std::string_view cell : header) columns.push_back(read_column_name(cell));
    auto time = column_for(columns, Quantity::time, "");
    if (!time) {
        // "stamp_ns" alone is a time, not a fraction of one.
        for (ColumnName& column : columns)
            if (column.quantity == Quantity::time_fraction) column.quantity = Quantity::time;
        time = column_for(columns, Quantity::time, "");
    }
    Layout layout;
    bool of_gyros = false;
    for (const auto& [quantity, bare] : {std::pair{Quantity::increment, false}, {Quantity::rate, false}, {Quantity::rate, true}}) {
        if (of_gyros) break;  // rates besides increments are of the same gyros
        const auto owners = by_owner(columns, quantity, bare);
        for (const auto& [owner, axes] : owners) {
            const auto value = triple(axes, 0);
            if (!value) continue;
            of_gyros = true;
            if (!time) continue;
            if (axes.size() % 3 != 0 && quantity == Quantity::increment && owner.empty())
                return tl::unexpected(
                    fmt::format("{} axes are no triads: replay such a log with a system file that names their layout", axes.size()));
            const bool numbered = quantity == Quantity::increment && columns[(*value)[0]].text.starts_with("increment_");
            if (numbered) add_numbered(columns, axes, *time, layout.gyros);
            else
                layout.gyros.push_back(gyro_of(columns, owner, *value, quantity, column_for(columns, Quantity::time, owner).value_or(*time),
                                               owners.size() == 1));
        }
    }
    if (!of_gyros) return std::nullopt;
    if (!time) return tl::unexpected(std::string("columns of a gyro, and none of a time (time_s, t, timestamp …)"));
    std::sort(layout.gyros.begin(), layout.gyros.end(), [](const auto& a, const auto& b) { return a.value[0] < b.value[0]; });
    if (layout.gyros.size() == 1) {
        layout.identity = column_for(columns, Quantity::identity, "");
        if (layout.identity) layout.identity_name = columns[*layout.identity].text;
    }
    layout.needed = needed_cells(layout);
    return layout;
}

}  // namespace quorient::recording::csv
