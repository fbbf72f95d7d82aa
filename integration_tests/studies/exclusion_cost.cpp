#include "exclusion_cost.hpp"

#include "detection_trial.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace quorient::studies {

namespace {

constexpr std::size_t lengths[] = {1, 2, 4, 8, 16, 62};

/// The body's increment by weighted least squares of these axes.
Eigen::Vector3d body_increment(const geometry::SensorCluster& cluster, const SensorFrame& frame, AxisMask used)
{
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        if (!has_axis(used, axis)) continue;
        const auto row = static_cast<Eigen::Index>(axis);
        const Eigen::Vector3d direction = cluster.axes.row(row).transpose() / (cluster.sigma(row) * cluster.sigma(row));
        information += direction * cluster.axes.row(row);
        sum += direction * frame.increment[axis];
    }
    return information.inverse() * sum;
}

/// Per frame of the motion, what leaving the instrument out changes, summed from the beginning.
std::vector<Eigen::Vector3d> summed_changes(const RecordedArray& array, AxisMask instrument)
{
    std::vector<Eigen::Vector3d> sums{Eigen::Vector3d::Zero()};
    const AxisMask all = array.cluster.all();
    for (std::size_t i = array.motion.begin; i < array.motion.end; ++i)
        sums.emplace_back(sums.back() + body_increment(array.cluster, array.frames[i], all & ~instrument) -
                          body_increment(array.cluster, array.frames[i], all));
    return sums;
}

}  // namespace

std::vector<ExclusionCost> exclusion_costs(const std::vector<RecordedArray>& arrays)
{
    std::vector<ExclusionCost> costs;
    for (std::size_t place = 0; place < arrays.size(); ++place) {
        const RecordedArray& array = arrays[place];
        std::vector<std::vector<Eigen::Vector3d>> changes;
        for (std::size_t m = 0; m < array.cluster.instrument_name.size(); ++m)
            changes.push_back(summed_changes(array, array.cluster.axes_of(m)));
        for (const std::size_t frames : lengths) {
            std::vector<double> angles;
            for (const auto& sums : changes)
                for (std::size_t end = frames; end < sums.size(); ++end) angles.push_back((sums[end] - sums[end - frames]).norm());
            if (angles.empty()) continue;
            std::sort(angles.begin(), angles.end());
            const auto above = angles.end() - std::upper_bound(angles.begin(), angles.end(), free_of_charge_rad);
            costs.push_back({.array = place,
                             .frames = frames,
                             .median_rad = angles[angles.size() / 2],
                             .ninth_decile_rad = angles[angles.size() * 9 / 10],
                             .share_above_free = static_cast<double>(above) / static_cast<double>(angles.size())});
        }
    }
    return costs;
}

}  // namespace quorient::studies
