#include "design_report.hpp"

#include "cli/json_output.hpp"
#include "quorient/design/recognise.hpp"
#include "quorient/messages/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

namespace quorient::cli {

std::string how_searched(const design::SearchResult& result)
{
    switch (result.searched) {
        case design::Searched::wholly: return fmt::format("all {} choices of places", result.tried);
        case design::Searched::by_exchange: return fmt::format("{} choices of places, by exchange", result.tried);
        case design::Searched::locally: break;
    }
    return fmt::format("{} local searches", result.tried);
}

namespace {

using design::Bounds;
using design::Design;
using design::Figures;

std::string figure_cell(double value, bool whole = false)
{
    if (whole) return fmt::format("{:>14.0f}", value);
    if (!std::isfinite(value)) return fmt::format("{:>14}", "-");
    const double size = std::abs(value);
    if (size != 0 && (size >= 1e5 || size < 1e-3)) return fmt::format("{:>14.6e}", value);
    return fmt::format("{:>14.8f}", value);
}

/// One row of the table of figures: how it is called, of a design, and its bound where there is one.
struct Row {
    std::string name;
    std::function<double(const Figures&)> of;
    double bound = undefined;
    bool whole = false;  ///< a count
};

void add_worst(std::vector<Row>& rows, std::size_t place, const Bounds& bounds)
{
    const auto after = [place](double design::AfterFailures::*member) {
        return [place, member](const Figures& figures) {
            return place < figures.worst_after.size() ? figures.worst_after[place].*member : undefined;
        };
    };
    const bool bounded = place < bounds.worst_after.size();
    const std::string when = fmt::format("worst after {}", place + 1);
    rows.push_back({when + ": trace", after(&design::AfterFailures::trace), bounded ? bounds.worst_after[place].trace : undefined});
    rows.push_back({when + ": volume", after(&design::AfterFailures::volume), bounded ? bounds.worst_after[place].volume : undefined});
    rows.push_back({when + ": condition", after(&design::AfterFailures::condition), 1});
}

std::vector<Row> rows_of(const Figures& example, const Bounds& bounds)
{
    std::vector<Row> rows{{"trace", [](const Figures& f) { return f.trace; }, bounds.trace},
                          {"volume", [](const Figures& f) { return f.volume; }, bounds.volume},
                          {"condition", [](const Figures& f) { return f.condition; }, bounds.condition},
                          {"smallest angle, deg", [](const Figures& f) { return f.minimum_angle_rad / degree; }, bounds.minimum_angle_rad / degree}};
    for (std::size_t place = 0; place < example.worst_after.size(); ++place) add_worst(rows, place, bounds);
    rows.push_back({"F_d1", [](const Figures& f) { return f.f_d1; }, bounds.f_d1});
    rows.push_back({"F_d2", [](const Figures& f) { return f.f_d2; }, bounds.f_d2});
    rows.push_back({"faults detected, any size", [](const Figures& f) { return f.detectable; }, static_cast<double>(bounds.detectable), true});
    rows.push_back({"faults isolated, any size", [](const Figures& f) { return f.isolable; }, static_cast<double>(bounds.isolable), true});
    rows.push_back({"one fault detected, sigma", [](const Figures& f) { return f.fault.detected_axis; }});
    rows.push_back({"one fault isolated, sigma", [](const Figures& f) { return f.fault.isolated_axis; }});
    rows.push_back({"two equal detected, sigma", [](const Figures& f) { return f.fault.detected_pair; }});
    rows.push_back({"two equal isolated, sigma", [](const Figures& f) { return f.fault.isolated_pair; }});
    if (example.mounted_trace) rows.push_back({"as mounted: worst trace", [](const Figures& f) { return f.mounted_trace.value_or(undefined); }});
    if (example.survival) {
        rows.push_back({"survival", [](const Figures& f) { return f.survival ? f.survival->probability : undefined; }, 1});
        rows.push_back({"  standard error", [](const Figures& f) { return f.survival ? f.survival->standard_error : undefined; }});
        rows.push_back({"  first failure isolated",
                        [](const Figures& f) { return f.survival && !f.survival->coverage.empty() ? f.survival->coverage.front() : undefined; }, 1});
    }
    return rows;
}

/// What the traces are in.
const char* noise_label(bool unit)
{
    return unit ? "noise of each axis = 1" : "noise as given";
}

void append_figures(std::string& text, const std::vector<const Figures*>& columns, const Bounds& bounds)
{
    for (const Row& row : rows_of(*columns.front(), bounds)) {
        fmt::format_to(std::back_inserter(text), "{:<28}", row.name);
        for (const Figures* figures : columns) text += figure_cell(row.of(*figures), row.whole);
        text += figure_cell(row.bound, row.whole) + '\n';
    }
}

/// Without the sign of a zero.
double shown(double component)
{
    return std::abs(component) < 5e-9 ? 0 : component;
}

void append_axes(std::string& text, const geometry::SensorCluster& cluster)
{
    fmt::format_to(std::back_inserter(text), "{:>4} {:>10} {:>12}{:>12}{:>12}\n", "axis", "instrument", "x", "y", "z");
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        fmt::format_to(std::back_inserter(text), "{:>4} {:>10} {:>12.8f}{:>12.8f}{:>12.8f}\n", axis, cluster.instrument[axis],
                       shown(cluster.axes(i, 0)), shown(cluster.axes(i, 1)), shown(cluster.axes(i, 2)));
    }
}

std::string described(const Design& design)
{
    std::string text;
    if (const auto name = design::same_as(design.cluster.axes); !name.empty()) text += fmt::format(", as the layout {}", name);
    if (design.symmetry > 1) text += fmt::format(", the same after a turn of {:g} deg about z", 360.0 / design.symmetry);
    return text;
}

Json bound_json(const Bounds& bounds)
{
    Json json{{"trace", bounds.trace},
              {"volume", bounds.volume},
              {"condition", bounds.condition},
              {"minimum_angle_deg", bounds.minimum_angle_rad / degree}};
    json["worst_after"] = Json::array();
    for (const auto& after : bounds.worst_after)
        json["worst_after"].push_back({{"failures", after.failures}, {"trace", after.trace}, {"volume", after.volume}});
    json["F_d1"] = bounds.f_d1;
    json["F_d2"] = bounds.f_d2;
    return json;
}

Json worst_json(const Figures& figures)
{
    Json list = Json::array();
    for (const auto& after : figures.worst_after)
        list.push_back({{"failures", after.failures}, {"trace", after.trace}, {"volume", after.volume}, {"condition", after.condition}});
    return list;
}

}  // namespace

Json design_json(const design::SearchResult& result)
{
    Json designs = Json::array();
    for (const Design& design : result.designs) {
        const Figures& figures = design.figures;
        Json json;
        json["axes"] = matrix_json(design.cluster.axes);
        json["trace"] = figures.trace;
        json["volume"] = figures.volume;
        json["condition"] = figures.condition;
        json["minimum_angle_deg"] = figures.minimum_angle_rad / degree;
        json["worst_after"] = worst_json(figures);
        json["F_d1"] = figures.f_d1;
        json["F_d2"] = figures.f_d2;
        json["survival"] = figures.survival ? Json(figures.survival->probability) : Json(nullptr);
        designs.push_back(std::move(json));
    }
    return {{"designs", std::move(designs)}, {"bound", bound_json(result.bounds)}};
}

std::string mission_text(const design::Mission& mission)
{
    std::string rates = fmt::format("{:g} failures per axis and hour", mission.axis_failures_per_h);
    if (mission.instrument_failures_per_h > 0) rates += fmt::format(", {:g} per instrument and hour", mission.instrument_failures_per_h);
    if (!mission.shared.empty()) rates += fmt::format(", {} shared {}", mission.shared.size(), mission.shared.size() == 1 ? "part" : "parts");
    return fmt::format(
        "{:g} h, {}; a failed axis is wrong by {:g} to {:g} sigma and has to be isolated within {} frames; {} missions with a failure are played",
        mission.hours, rates, mission.least_fault_sigma, mission.most_fault_sigma, mission.frames, mission.trials);
}

std::string design_text(const design::Brief& brief, const design::SearchResult& result, design::Objective objective)
{
    const bool none = result.designs.empty();
    const auto& designs = none ? result.nearest : result.designs;
    std::string text = fmt::format("{} axes, from {}; {}\n", brief.axis_count(), how_searched(result),
                                   none ? "NO ARRAY FOUND MEETS ALL DEMANDS; the one that comes nearest:"
                                        : fmt::format("best {} first, none beaten in everything by another:",
                                                      design::objectives()[static_cast<std::size_t>(objective)].name));
    if (brief.mission) text += "survival: " + mission_text(*brief.mission) + '\n';
    if (designs.empty()) return text;
    std::vector<const Figures*> columns;
    for (std::size_t place = 0; place < designs.size(); ++place) {
        fmt::format_to(std::back_inserter(text), "\ndesign {}{}\n", place + 1, described(designs[place]));
        append_axes(text, designs[place].cluster);
        columns.push_back(&designs[place].figures);
    }
    fmt::format_to(std::back_inserter(text), "\n{:<28}", noise_label(brief.noise.empty()));
    for (std::size_t place = 0; place < designs.size(); ++place)
        fmt::format_to(std::back_inserter(text), "{:>14}", fmt::format("design {}", place + 1));
    fmt::format_to(std::back_inserter(text), "{:>14}\n", "bound");
    append_figures(text, columns, result.bounds);
    return text;
}

std::string design_table(const Design& design, const Bounds& bounds)
{
    const bool unit_noise = (design.cluster.sigma.array() == 1).all();
    std::string text = fmt::format("{} axes{}\n", design.cluster.size(), described(design));
    append_axes(text, design.cluster);
    return text + '\n' + figures_text(design.figures, bounds, unit_noise);
}

std::string figures_text(const Figures& figures, const Bounds& bounds, bool unit_noise)
{
    std::string text = fmt::format("{:<28}{:>14}{:>14}\n", noise_label(unit_noise), "", "bound");
    append_figures(text, {&figures}, bounds);
    return text;
}

Json figures_json(const Figures& figures)
{
    return {{"worst_after", worst_json(figures)},
            {"detected_axis_sigma", figures.fault.detected_axis},
            {"isolated_axis_sigma", figures.fault.isolated_axis},
            {"detected_pair_sigma", figures.fault.detected_pair},
            {"isolated_pair_sigma", figures.fault.isolated_pair},
            {"mounted_trace", figures.mounted_trace ? Json(*figures.mounted_trace) : Json(nullptr)},
            {"survival", figures.survival ? Json(figures.survival->probability) : Json(nullptr)}};
}

std::string removals_text(const geometry::SensorCluster& cluster, const std::vector<design::Removal>& removals, bool instruments)
{
    const bool known_noise = (cluster.sigma.array() > 0).any();
    std::string text = fmt::format("Removing one of {} {}, the cheapest first; {}\n{:<14}{:>14}{:>14}{:>18}{:>12}{:>12}\n", removals.size(),
                                   instruments ? "instruments" : "axes", known_noise ? "noise as calibrated" : "noise of each axis = 1",
                                   instruments ? "instrument" : "axis", "trace", "condition", "worst after 1", "F_d1", "F_d2");
    for (const design::Removal& removal : removals) {
        const Figures& figures = removal.figures;
        const std::size_t owner = instruments ? removal.unit : cluster.instrument[removal.unit];
        fmt::format_to(std::back_inserter(text), "{:<14}", fmt::format("{} ({})", removal.unit, cluster.instrument_name[owner]));
        text += figure_cell(figures.trace) + figure_cell(figures.condition) + "    " +
                figure_cell(figures.worst_after.empty() ? undefined : figures.worst_after.front().trace);
        for (const double figure : {figures.f_d1, figures.f_d2})
            text += fmt::format("{:>12}", std::isfinite(figure) ? fmt::format("{:.6f}", figure) : "-");
        text += '\n';
    }
    return text;
}

Json removals_json(const std::vector<design::Removal>& removals, bool instruments)
{
    Json list = Json::array();
    for (const design::Removal& removal : removals)
        list.push_back({{instruments ? "instrument" : "axis", removal.unit},
                        {"trace", removal.figures.trace},
                        {"volume", removal.figures.volume},
                        {"condition", removal.figures.condition},
                        {"worst_after", worst_json(removal.figures)},
                        {"F_d1", removal.figures.f_d1},
                        {"F_d2", removal.figures.f_d2}});
    return {{"removals", std::move(list)}};
}

std::string axes_file_text(const Design& design, const std::string& origin)
{
    std::string text = fmt::format("# An array by {}\n# In a system file: unit: {{axes: THIS_FILE}}\naxes:\n", origin);
    for (Eigen::Index axis = 0; axis < design.cluster.axes.rows(); ++axis)
        fmt::format_to(std::back_inserter(text), "  - [{:.17g}, {:.17g}, {:.17g}]\n", design.cluster.axes(axis, 0),
                       design.cluster.axes(axis, 1), design.cluster.axes(axis, 2));
    return text + fmt::format("instrument: [{}]\n", fmt::join(design.cluster.instrument, ", "));
}

}  // namespace quorient::cli
