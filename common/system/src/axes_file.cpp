#include "quorient/system/axes_file.hpp"

#include "quorient/calibration/cluster_file.hpp"
#include "quorient/configuration/document.hpp"
#include "quorient/configuration/section.hpp"

#include <fmt/format.h>
#include <cstdint>
#include <vector>

namespace quorient::system {

namespace {

using Loaded = tl::expected<geometry::SensorCluster, std::string>;

/// One axis as [x, y, z]. A problem is reported at its place.
Eigen::RowVector3d axis_of(const YAML::Node& node, std::size_t number, configuration::Problems& problems)
{
    Eigen::RowVector3d axis = Eigen::RowVector3d::UnitZ();
    const bool listed = node.IsSequence() && node.size() == 3;
    for (std::size_t part = 0; listed && part < 3; ++part) {
        double value = 0;
        if (YAML::convert<double>::decode(node[part], value)) axis(static_cast<Eigen::Index>(part)) = value;
        else problems.add(node[part].Mark(), "axes", fmt::format("axis {} has a component that is no number", number));
    }
    if (!listed) problems.add(node.Mark(), "axes", fmt::format("axis {} must be [x, y, z]", number));
    else if (const auto problem = geometry::unit_norm_problem(axis)) problems.add(node.Mark(), "axes", fmt::format("axis {}: {}", number, *problem));
    return axis;
}

Loaded plain_axes(const std::string& file, const YAML::Node& document)
{
    configuration::Problems problems(file);
    configuration::Section root(document, "", problems);
    const YAML::Node list = root.raw("axes");
    std::vector<std::uint32_t> numbers;
    root.wholes("instrument", numbers);
    geometry::Axes axes(0, 3);
    if (list.size() <= max_axes) axes.resize(static_cast<Eigen::Index>(list.size()), 3);
    else root.problem("axes", fmt::format("{} axes given; at most {} are supported", list.size(), max_axes));
    for (Eigen::Index axis = 0; axis < axes.rows(); ++axis)
        axes.row(axis) = axis_of(list[static_cast<std::size_t>(axis)], static_cast<std::size_t>(axis), problems);
    root.finish();
    if (!problems.empty()) return tl::unexpected(problems.lines());
    auto cluster = geometry::make_cluster(axes, {numbers.begin(), numbers.end()});
    if (!cluster) return tl::unexpected(fmt::format("{}: {}", file, cluster.error()));
    return cluster;
}

}  // namespace

Loaded load_axes_file(const std::string& file)
{
    const auto document = configuration::load_yaml(file);
    if (!document) return tl::unexpected(document.error().lines());
    const YAML::Node axes = (*document)["axes"];
    if (!axes || !axes.IsSequence() || axes.size() == 0)
        return tl::unexpected(fmt::format("{}: expected `axes`, a list of [x, y, z], as `quorient design --out` writes it", file));
    if (!axes[0].IsMap()) return plain_axes(file, *document);
    const auto calibrated = calibration::load_cluster(file);
    if (!calibrated) return tl::unexpected(calibrated.error());
    return geometry::make_cluster(calibrated->description);
}

}  // namespace quorient::system
