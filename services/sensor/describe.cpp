#include "describe.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::sensor {

ClusterDescription describe(const geometry::SensorCluster& cluster)
{
    ClusterDescription description;
    description.interval_s = cluster.interval_s;
    description.kind = octet(cluster.kind);
    description.axis_count = static_cast<std::uint8_t>(cluster.size());
    std::size_t instruments = 0;
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        const auto row = static_cast<Eigen::Index>(axis);
        for (std::size_t j = 0; j < 3; ++j) description.axis[axis][j] = cluster.axes(row, static_cast<Eigen::Index>(j));
        description.sigma[axis] = cluster.sigma(row);
        description.quantum[axis] = cluster.quantum(row);
        description.range[axis] = cluster.range(row);
        description.instrument[axis] = static_cast<std::uint8_t>(cluster.instrument[axis]);
        instruments = std::max(instruments, cluster.instrument[axis] + 1);
    }
    description.instrument_count = static_cast<std::uint8_t>(instruments);
    for (std::size_t i = 0; i < instruments; ++i) {
        const bool named = i < cluster.instrument_name.size() && !cluster.instrument_name[i].empty();
        copy_text(named ? cluster.instrument_name[i] : fmt::format("G{}", i + 1), description.instrument_name[i]);
    }
    return description;
}

}  // namespace quorient::sensor
