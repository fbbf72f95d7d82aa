#include "array_design.hpp"

#include "cli/parallel.hpp"
#include "quorient/design/mission.hpp"
#include "quorient/geometry/figures.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/messages/units.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace quorient::studies {

namespace {

using design::Brief;
using design::Design;
using design::Objective;

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

Brief brief_of(std::size_t instruments, unsigned axes_each, design::Mounting mounting = design::FreeMounting{})
{
    Brief brief;
    brief.instruments = instruments;
    brief.axes_each = axes_each;
    brief.mounting = std::move(mounting);
    return brief;
}

design::ForEach on_all_cores(const RunSettings& settings)
{
    return [threads = settings.threads](std::size_t count, const std::function<void(std::size_t)>& task) { cli::for_each(count, threads, {}, task); };
}

design::SearchResult searched(const Brief& brief, const RunSettings& settings, Objective objective = Objective::trace)
{
    return design::search(brief, {.objective = objective, .seed = settings.seed}, on_all_cores(settings)).value();
}

design::Figures figures_of(const std::string& layout, unsigned failures = 2)
{
    const auto cluster = geometry::layout(layout).value();
    return design::judge(cluster.axes, design::Yardstick::of(cluster, failures));
}

/// What the paper compares: with the partner axis of a two-axis gyro left out, where there is one.
double compared_f_d2(const geometry::SensorCluster& cluster)
{
    if (cluster.size() <= 3) return 0;  // as the paper writes where there is no parity equation
    return geometry::f_d2_partner_excluded(cluster.axes, cluster.instrument).value_or(geometry::f_d2(geometry::ParitySpace(cluster.axes)));
}

// Known optima

void add_accuracy(std::vector<Proof>& proofs, const std::string& asked, const Design& found, const std::string& layout, const design::Bounds& bounds)
{
    const design::Figures known = figures_of(layout, static_cast<unsigned>(found.figures.worst_after.size()));
    const std::string source = "layout " + layout;
    proofs.push_back({asked, "trace", found.figures.trace, known.trace, bounds.trace, source});
    proofs.push_back({asked, "volume", found.figures.volume, known.volume, bounds.volume, source});
    proofs.push_back({asked, "condition", found.figures.condition, known.condition, bounds.condition, source});
    for (std::size_t k = 0; k < known.worst_after.size(); ++k) {
        const auto& own = found.figures.worst_after[k];
        proofs.push_back({asked, fmt::format("trace, worst after {}", k + 1), own.trace, known.worst_after[k].trace, bounds.worst_after[k].trace, source});
        proofs.push_back({asked, fmt::format("volume, worst after {}", k + 1), own.volume, known.worst_after[k].volume, bounds.worst_after[k].volume, source});
    }
    proofs.push_back({asked, "F_d2", found.figures.f_d2, known.f_d2, bounds.f_d2, source});
    proofs.push_back({asked, "smallest angle, deg", found.figures.minimum_angle_rad / degree, known.minimum_angle_rad / degree, bounds.minimum_angle_rad / degree, source});
}

/// Elevation above the plane of symmetry, and azimuth, of the first axis of each group of three.
void add_two_cones(std::vector<Proof>& proofs, const RunSettings& settings)
{
    const auto axes = searched(brief_of(6, 1, design::SymmetricMounting{Eigen::Vector3d::UnitZ(), 3}), settings).designs.front().cluster.axes;
    struct Cone {
        double elevation_deg, azimuth_deg;
    };
    std::vector<Cone> cones;
    for (const Eigen::Index first : {0, 3}) {
        const Eigen::RowVector3d up = axes(first, 2) < 0 ? Eigen::RowVector3d(-axes.row(first)) : Eigen::RowVector3d(axes.row(first));
        cones.push_back({std::asin(up.z()) / degree, std::atan2(up.y(), up.x()) / degree});
    }
    if (cones[0].elevation_deg < cones[1].elevation_deg) std::swap(cones[0], cones[1]);
    const double root = std::sqrt(5.0);
    const std::string asked = "6 axes on two cones (three-fold symmetry)", source = "paper 002: 52.6226, 10.8123, 60";
    proofs.push_back({asked, "first cone, deg", cones[0].elevation_deg, std::asin(std::sqrt((root + 2) / (3 * root))) / degree, undefined, source});
    proofs.push_back({asked, "second cone, deg", cones[1].elevation_deg, std::asin(std::sqrt((root - 2) / (3 * root))) / degree, undefined, source});
    proofs.push_back({asked, "turned by, deg", std::abs(std::remainder(cones[1].azimuth_deg - cones[0].azimuth_deg, 120)), 60, undefined, source});
}

void add_spacing(std::vector<Proof>& proofs, std::size_t axes, double known_deg, const RunSettings& settings)
{
    const auto result = searched(brief_of(axes, 1), settings, Objective::minimum_angle);
    proofs.push_back({fmt::format("{} axes, objective minimum_angle", axes), "smallest angle, deg", result.designs.front().figures.minimum_angle_rad / degree,
                      known_deg, result.bounds.minimum_angle_rad / degree, "Conway, Hardin & Sloane 1996, four decimals", 5e-5});
}

// Paper 004

struct Architecture {
    const char* matrix;
    const char* layout;
    double printed;
    int rank;
};

constexpr Architecture architectures[] = {
    {"H1", "dodecahedron-h1", 5.0, 1}, {"H2", "dodecahedron-h2", 5.0, 1}, {"H3", "octahedron-6", 4.0, 2},    {"H4", "orthogonal-3", 0, 8},
    {"H5", "tetrad", 1, 7},            {"H6", "tetrad-2", 1, 7},          {"H7", "cone-5", 1.52, 6},         {"H8", "octahedron-8", 3.36, 4},
    {"H9", "tdof-symmetric", 3.3, 4},  {"H10", "tdof-orthogonal", 1.8, 5}, {"H11", "tdof-coplanar", 3.7, 3},
};

constexpr double tie = 1e-6;

/// 1 + how many different values are larger.
int rank_among(double value, std::vector<double> all)
{
    std::ranges::sort(all, std::greater{});
    all.erase(std::unique(all.begin(), all.end(), [](double a, double b) { return std::abs(a - b) < tie; }), all.end());
    return 1 + static_cast<int>(std::ranges::count_if(all, [&](double other) { return other > value + tie; }));
}

/// The best of the designs for as many sensors of the same kind, in each figure on its own.
void add_best(Ranked& row, const geometry::SensorCluster& cluster, const RunSettings& settings)
{
    if (cluster.size() <= 3) return;
    const bool pairs = cluster.instrument_name.size() < cluster.size();
    const Brief brief = brief_of(pairs ? cluster.size() / 2 : cluster.size(), pairs ? 2 : 1);
    row.f_d2_best = 0;
    row.worst_trace_best = std::numeric_limits<double>::infinity();
    for (const Objective objective : {Objective::trace, Objective::f_d2, Objective::worst_trace})
        for (const Design& design : searched(brief, settings, objective).designs) {
            row.f_d2_best = std::max(row.f_d2_best, compared_f_d2(design.cluster));
            if (design.figures.worst_after.size() > 1) row.worst_trace_best = std::min(row.worst_trace_best, design.figures.worst_after[1].trace);
        }
}

// Places

std::vector<double> steps(int count)
{
    std::vector<double> angles;
    for (int k = 0; k < count; ++k) angles.push_back(2 * std::numbers::pi * k / count);
    return angles;
}

design::WedgeMounting wedges(int azimuths, std::vector<double> turns)
{
    return {{0, 30 * degree, 45 * degree, 60 * degree}, steps(azimuths), std::move(turns)};
}

Brief with_failures(Brief brief, unsigned failures)
{
    brief.failures = failures;
    return brief;
}

double figure_of(const design::SearchResult& result, Objective objective)
{
    return design::cost(result.designs.front().figures, objective);
}

// Survey

struct Family {
    const char* name;
    std::vector<std::size_t> axes;
    geometry::SensorCluster (*make)(std::size_t axes, const RunSettings& settings);
};

geometry::SensorCluster named(const std::string& layout)
{
    return geometry::layout(layout).value();
}

const std::vector<Family>& families()
{
    static const std::vector<std::size_t> all{4, 5, 6, 7, 8, 9, 10, 11, 12};
    static const std::vector<Family> list{
        {"aligned triads", {3, 6, 9, 12}, [](std::size_t n, const RunSettings&) { return named(fmt::format("triads-{}", n / 3)); }},
        {"triads as designed", {6, 9, 12},
         [](std::size_t n, const RunSettings& settings) { return searched(brief_of(n / 3, 3), settings).designs.front().cluster; }},
        {"cone", all, [](std::size_t n, const RunSettings&) { return named(fmt::format("cone-{}", n)); }},
        {"cone with axis", all, [](std::size_t n, const RunSettings&) { return named(fmt::format("cone-axis-{}", n)); }},
        {"axes as designed", all, [](std::size_t n, const RunSettings& settings) { return searched(brief_of(n, 1), settings).designs.front().cluster; }},
    };
    return list;
}

design::Mission ten_years(const RunSettings& settings)
{
    return {.hours = 87'660, .axis_failures_per_h = 2e-6, .trials = settings.trials};
}

// The report

std::string cell(double value, int digits = 10)
{
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

void append_proofs(std::string& text, const std::vector<Proof>& proofs)
{
    text += "## Known optima, found without being given\n\n| asked | figure | found | known | difference | bound of any array | beyond the bound | known from |\n|---|---|---|---|---|---|---|---|\n";
    for (const Proof& proof : proofs) {
        const double apart = std::isfinite(proof.bound) ? std::abs(proof.found / proof.bound - 1) : undefined;
        fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {:.1e} | {} | {} | {} |\n", proof.asked, proof.figure, cell(proof.found), cell(proof.known),
                       std::abs(proof.found - proof.known), cell(proof.bound), std::isnan(apart) ? "-" : apart < 1e-9 ? "met" : fmt::format("{:.2f} %", 100 * apart), proof.source);
    }
}

std::string gain(double own, double best, bool more)
{
    if (!std::isfinite(own) || !std::isfinite(best) || own == 0 || best == 0) return "-";
    const double ratio = more ? best / own : own / best;
    return ratio < 1 + 1e-6 ? "equal" : fmt::format("{:.1f} %", 100 * (ratio - 1));
}

void append_ranking(std::string& text, const std::vector<Ranked>& rows)
{
    text += "\n## Paper 004: its eleven arrays, ranked by F_d2, and the best found for as many sensors of the same kind\n\n"
            "| array | layout | F_d2 printed | ours | rank printed | ours | best found | better by | worst trace after 2 | best found | better by |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Ranked& row : rows)
        fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", row.matrix, row.layout, row.f_d2_printed, cell(row.f_d2, 4),
                       row.rank_printed, row.rank, cell(row.f_d2_best, 4), gain(row.f_d2, row.f_d2_best, true), cell(row.worst_trace, 4),
                       cell(row.worst_trace_best, 4), gain(row.worst_trace, row.worst_trace_best, false));
    text += "\nH9 to H11 are four gyros of two axes each: F_d2 with the partner axis left out, as the paper's Tables 1 to 3 do it. The paper calls 3.36 and 3.3 equal.\n";
}

void append_enumerations(std::string& text, const std::vector<Enumerated>& rows)
{
    text += "\n## Finite numbers of places: every choice against the exchange search\n\n| brief | objective | choices | cost by every choice | by exchange | difference |\n|---|---|---|---|---|---|\n";
    for (const Enumerated& row : rows)
        fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {:.1e} |\n", row.brief, row.objective, row.choices, cell(row.by_all), cell(row.by_exchange),
                       std::abs(row.by_all - row.by_exchange));
}

struct Timed {
    std::string brief, mounting;
    design::Figures figures;
    std::size_t tried = 0;
    double seconds = 0;
};

std::vector<Timed> runs(const RunSettings& settings)
{
    const std::pair<const char*, design::Mounting> mountings[] = {
        {"free", design::FreeMounting{}}, {"cone", design::ConeMounting{}}, {"wedges of 0, 30, 45, 60 deg, azimuths in steps of 60, turns 0 and 45", wedges(6, {0, 45 * degree})}};
    std::vector<Timed> rows;
    const auto add = [&](const Brief& brief, const std::string& name, const char* mounting) {
        const auto begin = std::chrono::steady_clock::now();
        const auto result = searched(brief, settings);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        rows.push_back({name, mounting, result.designs.front().figures, result.tried, took.count()});
    };
    for (const auto& [name, mounting] : mountings) {
        for (std::size_t n = 4; n <= 8; ++n) add(brief_of(n, 1, mounting), fmt::format("{} axes", n), name);
        for (std::size_t n = 2; n <= 4; ++n) add(brief_of(n, 3, mounting), fmt::format("{} triads", n), name);
    }
    return rows;
}

void append_runs(std::string& text, const std::vector<Timed>& rows)
{
    text += "\n## 4 to 8 axes and 2 to 4 triads under three mountings\n\n| brief | mounting | trace | worst after 1 | worst after 2 | F_d2 | smallest angle, deg | searches or choices | s |\n|---|---|---|---|---|---|---|---|---|\n";
    for (const Timed& row : rows) {
        const auto after = [&](std::size_t k) { return k < row.figures.worst_after.size() ? cell(row.figures.worst_after[k].trace, 4) : "-"; };
        fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {} | {} | {} | {:.2f} |\n", row.brief, row.mounting, cell(row.figures.trace, 4), after(0), after(1),
                       cell(row.figures.f_d2, 4), cell(row.figures.minimum_angle_rad / degree, 3), row.tried, row.seconds);
    }
}

void append_survey(std::string& text, const Survey& surveyed)
{
    const cli::Chart& chart = surveyed.chart;
    text += "\n## Surviving ten years, 2e-6 failures per axis and hour\n\n| axes |";
    for (const cli::Series& series : chart.series) text += " " + series.name + " |";
    text += "\n|---|" + [&] {
        std::string line;
        for (std::size_t k = 0; k < chart.series.size(); ++k) line += "---|";
        return line;
    }() + '\n';
    for (int n = 3; n <= 12; ++n) {
        text += fmt::format("| {} |", n);
        for (const cli::Series& series : chart.series) {
            const auto point = std::ranges::find(series.points, static_cast<double>(n), &std::pair<double, double>::first);
            text += point == series.points.end() ? " - |" : fmt::format(" {:.4f} |", point->second);
        }
        text += '\n';
    }
    fmt::format_to(std::back_inserter(text), "\nStandard errors are {:.4f} at most. The designed arrays are those that `design` lists first by its objective `trace`.\n", surveyed.largest_error);
}

}  // namespace

std::vector<Proof> known_optima(const RunSettings& settings)
{
    std::vector<Proof> proofs;
    for (const auto& [n, layout] : {std::pair(std::size_t{4}, "tetrad"), std::pair(std::size_t{5}, "cone-5"), std::pair(std::size_t{6}, "dodecahedron")}) {
        const auto result = searched(brief_of(n, 1), settings);
        add_accuracy(proofs, fmt::format("{} axes", n), result.designs.front(), layout, result.bounds);
    }
    add_two_cones(proofs, settings);
    const auto two = searched(brief_of(2, 3), settings);
    add_accuracy(proofs, "2 triads", two.designs.front(), "two-triads:1,1,1,60", two.bounds);
    add_spacing(proofs, 7, 54.7356, settings);
    add_spacing(proofs, 8, 49.6399, settings);
    return proofs;
}

std::vector<Ranked> paper_004_ranking(const RunSettings& settings)
{
    std::vector<double> all;
    for (const Architecture& one : architectures) all.push_back(compared_f_d2(named(one.layout)));
    std::vector<Ranked> rows;
    for (const Architecture& one : architectures) {
        const auto cluster = named(one.layout);
        const double own = compared_f_d2(cluster);
        Ranked row{one.matrix, one.layout, one.rank, rank_among(own, all), one.printed, own, undefined, undefined, undefined};
        if (cluster.size() > 4) row.worst_trace = figures_of(one.layout).worst_after[1].trace;
        add_best(row, cluster, settings);
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<Enumerated> enumerations(const RunSettings& settings)
{
    const std::pair<std::string, Brief> briefs[] = {
        {"6 axes at right angles, one failure", with_failures(brief_of(6, 1, design::RightAngleMounting{}), 1)},
        {"4 axes on wedges, azimuths in steps of 30", brief_of(4, 1, wedges(12, {}))},
        {"5 axes on wedges, azimuths in steps of 60", brief_of(5, 1, wedges(6, {}))},
        {"6 axes on wedges, azimuths in steps of 60", brief_of(6, 1, wedges(6, {}))},
        {"2 triads on wedges, azimuths in steps of 30, turns 0 and 45", brief_of(2, 3, wedges(12, {0, 45 * degree}))},
        {"3 triads on wedges, azimuths in steps of 60, turns 0 and 45", brief_of(3, 3, wedges(6, {0, 45 * degree}))},
    };
    std::vector<Enumerated> rows;
    for (const auto& [name, brief] : briefs)
        for (const Objective objective : {Objective::trace, Objective::worst_trace, Objective::f_d2, Objective::minimum_angle}) {
            design::SearchSettings search_settings{.objective = objective, .seed = settings.seed, .places = design::PlaceSearch::exhaustive};
            const auto all = design::search(brief, search_settings, on_all_cores(settings)).value();
            search_settings.places = design::PlaceSearch::exchange;
            const auto some = design::search(brief, search_settings, on_all_cores(settings)).value();
            const auto& entry = design::objectives()[static_cast<std::size_t>(objective)];
            rows.push_back({name, std::string(entry.name), all.tried, figure_of(all, objective), figure_of(some, objective)});
        }
    return rows;
}

Survey survey(const RunSettings& settings, const OnProgress& on_progress)
{
    Survey result;
    result.chart = {"Surviving ten years, 2e-6 failures per axis and hour", "axes", "probability", false, false, {}};
    cli::Chart& chart = result.chart;
    std::size_t all = 0, done = 0;
    for (const Family& family : families()) all += family.axes.size();
    for (const Family& family : families()) {
        cli::Series series{family.name, {}, cli::colour(chart.series.size()), true};
        for (const std::size_t n : family.axes) {
            const auto survival = design::survival(family.make(n, settings), ten_years(settings), settings.seed, on_all_cores(settings)).value();
            series.points.emplace_back(static_cast<double>(n), survival.probability);
            result.largest_error = std::max(result.largest_error, survival.standard_error);
            if (on_progress) on_progress(++done, all);
        }
        chart.series.push_back(std::move(series));
    }
    return result;
}

Report array_design(const RunSettings& settings, const OnProgress& on_progress)
{
    Report report;
    const auto proofs = known_optima(settings);
    const auto ranking = paper_004_ranking(settings);
    const auto enumerated = enumerations(settings);
    const auto timed = runs(settings);
    const Survey surveyed = survey(settings, on_progress);
    report.charts = {surveyed.chart};
    append_proofs(report.text, proofs);
    append_ranking(report.text, ranking);
    append_enumerations(report.text, enumerated);
    append_runs(report.text, timed);
    append_survey(report.text, surveyed);
    for (const Proof& proof : proofs)
        report.json["proofs"].push_back({{"asked", proof.asked}, {"figure", proof.figure}, {"found", proof.found}, {"known", proof.known}, {"bound", proof.bound}});
    for (const Ranked& row : ranking)
        report.json["paper_004"].push_back({{"array", row.matrix}, {"F_d2", row.f_d2}, {"rank", row.rank}, {"rank_printed", row.rank_printed}, {"F_d2_best", row.f_d2_best}});
    for (const Enumerated& row : enumerated)
        report.json["enumerations"].push_back({{"brief", row.brief}, {"objective", row.objective}, {"choices", row.choices}, {"all", row.by_all}, {"exchange", row.by_exchange}});
    for (const cli::Series& series : report.charts.front().series) report.json["survival"][series.name] = series.points;
    return report;
}

}  // namespace quorient::studies
