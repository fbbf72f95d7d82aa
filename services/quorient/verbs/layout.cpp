#include "cli/cluster_input.hpp"
#include "cli/program.hpp"
#include "cli/json_output.hpp"
#include "report/layout_report.hpp"
#include "report/layout_table.hpp"
#include "quorient/geometry/figures.hpp"
#include "quorient/geometry/layouts.hpp"
#include "report/design_report.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <memory>
#include <string>
#include <vector>

namespace quorient::cli {

namespace {

struct LayoutOptions {
    ClusterChoice choice;
    std::vector<std::size_t> without;
    bool table = false;
    bool design = false;
    bool json = false;
};

void print_catalogue(bool as_json)
{
    Json list = Json::array();
    for (const geometry::CatalogueEntry& entry : geometry::catalogue()) {
        if (as_json) list.push_back({{"name", entry.name}, {"source", entry.source}});
        else fmt::print("{:<26}{}\n", entry.name, entry.source);
    }
    if (as_json) fmt::print("{}\n", dump(list));
}

AxisMask axes_left(const LayoutOptions& options, const geometry::SensorCluster& cluster)
{
    AxisMask used = cluster.all();
    for (const std::size_t axis : options.without) {
        if (axis >= cluster.size()) fail(fmt::format("--without {}: {} has axes 0..{}", axis, options.choice.name(), cluster.size() - 1));
        used &= ~axis_bit(axis);
    }
    return used;
}

std::size_t axes_in_use(AxisMask used, const geometry::SensorCluster& cluster)
{
    return static_cast<std::size_t>(std::popcount(used & cluster.all()));
}

/// The bounds for so many axes, however they are mounted.
design::Bounds bounds_of(std::size_t axes)
{
    design::Brief brief;
    brief.instruments = axes;
    return design::bounds(brief);
}

/// The figures of the axes in use, each a unit of its own, after one and two failures where three axes would be left.
design::Figures judged(const geometry::SensorCluster& cluster, AxisMask used)
{
    const auto part = geometry::make_cluster(geometry::select(cluster.axes, used));
    if (!part) fail("--design: " + part.error());
    return design::judge(part->axes, design::Yardstick::of(*part, static_cast<unsigned>(std::min<std::size_t>(2, part->size() - 3))));
}

void print_layout(const LayoutOptions& options)
{
    const auto cluster = load_cluster(options.choice);
    if (!cluster) fail(cluster.error());
    const AxisMask used = axes_left(options, *cluster);
    if (options.json) {
        Json json = layout_json(options.choice.name(), *cluster, used);
        if (options.design) json["design"] = figures_json(judged(*cluster, used));
        fmt::print("{}\n", dump(json));
        return;
    }
    fmt::print("{}", layout_text(options.choice.name(), *cluster, used));
    if (options.design)
        fmt::print("\nwhat quorient design compares\n{}", figures_text(judged(*cluster, used), bounds_of(axes_in_use(used, *cluster))));
}

void run(const LayoutOptions& options)
{
    if (options.table) fmt::print("{}", options.json ? dump(papers_tables_json()) + '\n' : papers_tables_text());
    else if (!options.choice.name().empty()) print_layout(options);
    else if (!options.without.empty()) fail("--without needs a layout: name one of the catalogue, or give --axes FILE");
    else print_catalogue(options.json);
}

}  // namespace

void add_layout(Program& program)
{
    auto verb = program.verb("layout", "Figures of a sensor layout: accuracy, parity equations, what faults they show.");
    verb.footer(
        "Without NAME, lists the catalogue. Axes are 0-based, and keep their numbers when others are left out.\n\n"
        "Example: the dodecahedron after its first two axes have failed\n"
        "  quorient layout dodecahedron --without 0,1\n");
    const auto options = std::make_shared<LayoutOptions>();
    const auto name = verb.option("name", options->choice.layout, "a layout of the catalogue").value_name("NAME");
    const auto axes = verb.option("--axes", options->choice.axes_file,
                                  "a file of unit vectors: rows of x, y, z ('-' = stdin), or YAML of design or calibrate");
    const auto without =
        verb.numbers("--without", options->without, 0, "axes to leave out, as in 0,3");
    const auto table = verb.flag("--table", options->table, "the papers' tables beside ours, with the reason of every difference");
    verb.flag("--design", options->design, "also what `quorient design` compares: after failures, sizes of faults, bounds");
    verb.flag("--json", options->json, "one line of JSON, 17 significant digits, null where undefined");
    axes.in_place_of({name});
    table.in_place_of({name, axes, without});
    verb.run([options] { run(*options); });
}

}  // namespace quorient::cli
