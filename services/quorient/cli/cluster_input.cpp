#include "cluster_input.hpp"

#include "csv_input.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/system/axes_file.hpp"

#include <fmt/format.h>

namespace quorient::cli {

namespace {

tl::expected<geometry::SensorCluster, std::string> load_axes(const std::string& path)
{
    auto reader = CsvReader::open(path, {.columns = 3});
    if (!reader) return tl::unexpected(reader.error());

    geometry::Axes axes(max_axes, 3);
    Eigen::Index count = 0;
    for (CsvRow row;;) {
        const auto more = reader->next(row);
        if (!more) return tl::unexpected(more.error());
        if (!*more) break;
        const Eigen::RowVector3d axis(row.value[0], row.value[1], row.value[2]);
        if (count == max_axes) return tl::unexpected(reader->at(row.line, 1, fmt::format("at most {} axes are supported", max_axes)));
        if (const auto problem = geometry::unit_norm_problem(axis)) return tl::unexpected(reader->at(row.line, 1, *problem));
        axes.row(count++) = axis;
    }
    auto cluster = geometry::make_cluster(axes.topRows(count));
    if (!cluster) return tl::unexpected(fmt::format("{}: {}", path, cluster.error()));
    return cluster;
}

}  // namespace

void add_cluster_options(Verb& verb, ClusterChoice& choice)
{
    const auto layout = verb.option("--layout", choice.layout, "a layout of the catalogue (see `quorient layout`)");
    verb.option("--axes", choice.axes_file, "a file of unit vectors: rows of x, y, z, or YAML of design or calibrate").in_place_of({layout});
}

tl::expected<geometry::SensorCluster, std::string> load_cluster(const ClusterChoice& choice)
{
    const bool yaml = choice.axes_file.ends_with(".yaml") || choice.axes_file.ends_with(".yml");
    if (!choice.axes_file.empty()) return yaml ? system::load_axes_file(choice.axes_file) : load_axes(choice.axes_file);
    if (choice.layout.empty()) return tl::unexpected(std::string("no axes: name a layout of the catalogue, or give --axes FILE"));
    return geometry::layout(choice.layout);
}

}  // namespace quorient::cli
