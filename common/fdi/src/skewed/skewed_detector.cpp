#include "skewed/skewed_detector.hpp"

#include "field/state_rules.hpp"
#include "quorient/fdi/noise.hpp"
#include "skewed/state.hpp"

#include <utility>

namespace quorient::fdi {

tl::expected<std::unique_ptr<SkewedDetector>, std::string> SkewedDetector::make(const DetectorSettings& settings,
                                                                               const geometry::SensorCluster& cluster, const FieldRules& rules)
{
    if (const auto enough = require_axes(cluster, least_axes, "field"); !enough) return tl::unexpected(enough.error());
    if (const auto usable = field::check(settings, cluster); !usable) return tl::unexpected(usable.error());
    if (settings.mount == Mount::structure)
        return tl::unexpected(std::string("field: mount `structure` is known of instruments that each measure all three directions only"));
    geometry::SensorCluster normal = cluster;
    for (double& range : normal.range)
        if (!(range > 0)) range = figures_of(settings.sensor_class).usual_range_rad_s;
    return std::make_unique<State>(std::move(normal), settings, rules);
}

}  // namespace quorient::fdi
