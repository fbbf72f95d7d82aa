#include "field/field_detector.hpp"

#include "field/state.hpp"
#include "field/state_rules.hpp"

#include <algorithm>
#include <utility>

namespace quorient::fdi {
namespace {

/// Instruments numbered by their places in the array, and the usual range where none is stated.
geometry::SensorCluster normalised(const geometry::SensorCluster& cluster, double usual_range_rad_s)
{
    geometry::SensorCluster normal = cluster;
    std::vector<std::size_t> used = cluster.instrument;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::size_t& instrument : normal.instrument)
        instrument = static_cast<std::size_t>(std::lower_bound(used.begin(), used.end(), instrument) - used.begin());
    for (double& range : normal.range)
        if (!(range > 0)) range = usual_range_rad_s;
    return normal;
}

}  // namespace

tl::expected<std::unique_ptr<FieldDetector>, std::string> FieldDetector::make(const DetectorSettings& settings,
                                                                             const geometry::SensorCluster& cluster, const FieldRules& rules)
{
    if (const auto usable = field::check(settings, cluster); !usable) return tl::unexpected(usable.error());
    auto normal = normalised(cluster, figures_of(settings.sensor_class).usual_range_rad_s);
    const auto array = InstrumentArray::make(normal, geometry::AxisVector::Ones(normal.axes.rows()));
    if (!array) return tl::unexpected("field: " + array.error());
    return std::make_unique<State>(std::move(normal), *array, settings, rules);
}

}  // namespace quorient::fdi
