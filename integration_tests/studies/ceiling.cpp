#include "judges.hpp"
#include "quorient/design/fault_size.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/geometry/parity_space.hpp"
#include "study.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace quorient::studies {

namespace {

constexpr double false_alarm = 1e-6;
constexpr double detection = 0.99;
constexpr double isolation_size = 10;  // sigma

/// A row of the table "What a single frame can show at all" in docs/methods/README.md.
struct Row {
    const char* layout;
    double size;       ///< f/sigma for P_d 0.99
    double isolation;  ///< P(detected and right axis) at 10 sigma
};

constexpr Row rows[] = {
    {"orthogonal-3-plus-1", 17.7, 0},
    {"cone-4", 14.4, 0},
    {"tetrad", 14.4, 0},
    {"cone-5", 11.9, 0.84},
    {"cone-6", 10.9, 0.95},
    {"dodecahedron", 10.9, 0.95},
    {"two-triads:1,1,1,60", 10.9, 0.95},
    {"triads-2", 10.9, 0},
    {"triads-4", 9.8, 0.99},
    {"triads-8", 10.0, 0.99},
};

/// Two faults of one size: how often the likeliest pair is the right one.
struct DoubleRow {
    const char* layout;
    double size;
    double least;  ///< recomputed
    double most;
};

constexpr DoubleRow double_rows[] = {
    {"cone-6", 10, 0.44, 0.54},       {"cone-6", 40, 0.44, 0.54},        {"cone-6", 200, 0.44, 0.54}, {"dodecahedron", 10, 0.44, 0.54},
    {"dodecahedron", 40, 0.44, 0.54}, {"dodecahedron", 200, 0.44, 0.54}, {"cone-7", 10, 0.93, 0.93},  {"cone-7", 40, 1, 1},
};

geometry::SensorCluster cluster_of(const char* name)
{
    return geometry::layout(name).value();
}

/// The smallest P_ii: the axis that the others can say least about.
double worst_visibility(const geometry::SensorCluster& cluster)
{
    const geometry::ParitySpace space(cluster.axes);
    return space.projector().diagonal().minCoeff();
}

double size_for_detection(const geometry::SensorCluster& cluster)
{
    return design::detected_axis(geometry::ParitySpace(cluster.axes), {false_alarm, detection});
}

Scene scene_of(const geometry::SensorCluster& cluster, std::size_t faults, double size, const JudgeFactory& judge)
{
    Scene scene;
    scene.cluster = cluster;
    scene.faults = {.count = faults, .least = size, .most = size, .equal = true};
    scene.judges = {judge};
    return scene;
}

JudgeFactory likelihood_ratio()
{
    fdi::DetectorSettings settings;
    settings.method = "glt";
    settings.sigma = 1;
    settings.pfa = false_alarm;
    return method(settings);
}

std::vector<Scene> scenes()
{
    std::vector<Scene> all;
    for (const Row& row : rows) {
        const auto cluster = cluster_of(row.layout);
        all.push_back(scene_of(cluster, 1, size_for_detection(cluster), likelihood_ratio()));
        all.push_back(scene_of(cluster, 1, isolation_size, likelihood_ratio()));
    }
    for (const DoubleRow& row : double_rows) all.push_back(scene_of(cluster_of(row.layout), 2, row.size, likelihood_of_known_count()));
    return all;
}

void add_row(const Row& row, const Tally& at_size, const Tally& at_ten, Report& report)
{
    const auto cluster = cluster_of(row.layout);
    const double size = size_for_detection(cluster);
    const Rate detected = rate(at_size.trials() - at_size.missed, at_size.trials());
    const Rate isolated = rate(at_ten.correct, at_ten.trials());
    fmt::format_to(std::back_inserter(report.text),
                   "{:<22}{:>3}{:>8.2f}{:>7.1f}{:>+7.2f}{:>12.2f} ±{:.2f}{:>11.4f} ±{:.4f}{:>6.2f}{:>+8.3f}\n", row.layout, cluster.size(),
                   size, row.size, size - row.size, detected.percent, detected.error, isolated.percent / 100, isolated.error / 100,
                   row.isolation, isolated.percent / 100 - row.isolation);
    report.json["layouts"].push_back({{"layout", row.layout},
                                      {"axes", cluster.size()},
                                      {"size_sigma", size},
                                      {"published_size_sigma", row.size},
                                      {"detected_percent", detected.percent},
                                      {"detected_error", detected.error},
                                      {"isolated_at_10_sigma", isolated.percent / 100},
                                      {"isolated_error", isolated.error / 100},
                                      {"published_isolated", row.isolation}});
}

void add_double_row(const DoubleRow& row, const Tally& tally, Report& report)
{
    const Rate right = rate(tally.correct, tally.trials());
    fmt::format_to(std::back_inserter(report.text), "{:<22}{:>6.0f}{:>10.3f} ±{:.3f}{:>8.2f} .. {:.2f}\n", row.layout, row.size,
                   right.percent / 100, right.error / 100, row.least, row.most);
    report.json["equal_doubles"].push_back({{"layout", row.layout},
                                            {"size_sigma", row.size},
                                            {"right_pair", right.percent / 100},
                                            {"error", right.error / 100},
                                            {"published", {row.least, row.most}}});
}

/// Detection over the fault's size on the worst axis, exact.
cli::Chart detection_chart()
{
    cli::Chart chart{"Detection by a single sample, P_fa 1e-6, worst axis", "fault / sigma", "detected, %", false, false, {}};
    for (const Row& row : rows) {
        const auto cluster = cluster_of(row.layout);
        cli::Series series{row.layout, {}, cli::colour(chart.series.size()), true};
        for (double size = 0; size <= 20; size += 0.25)
            series.points.emplace_back(
                size, 100 * design::detection_probability(static_cast<unsigned>(cluster.size() - 3), worst_visibility(cluster), size, false_alarm));
        chart.series.push_back(std::move(series));
    }
    return chart;
}

}  // namespace

Report ceiling(const RunSettings& settings, const OnProgress& on_progress)
{
    const auto tallies = run(scenes(), settings, on_progress);
    Report report;
    report.text = fmt::format(
        "One faulty axis, white noise, one sample, P_fa {:g}.\n"
        "f/sigma: detected with probability {} on the worst axis (exact), beside recomputed; detected: Monte Carlo at that size, all "
        "axes;\n"
        "isolated: detected and the right axis named (glt) at {} sigma, beside recomputed\n\n"
        "{:<22}{:>3}{:>8}{:>7}{:>7}{:>17}{:>20}{:>6}{:>8}\n",
        false_alarm, detection, isolation_size, "layout", "n", "f/sigma", "pub.", "diff", "detected, %", "isolated", "pub.", "diff");
    std::size_t scene = 0;
    for (const Row& row : rows) {
        add_row(row, tallies[scene][0], tallies[scene + 1][0], report);
        scene += 2;
    }
    report.text += "\nTwo simultaneous faults of one size: how often the likeliest pair (known k) is the right one, beside recomputed\n\n";
    report.text += fmt::format("{:<22}{:>6}{:>17}{:>16}\n", "layout", "sigma", "right pair", "published");
    for (const DoubleRow& row : double_rows) add_double_row(row, tallies[scene++][0], report);
    report.charts = {detection_chart()};
    return report;
}

}  // namespace quorient::studies
