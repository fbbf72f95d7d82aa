#include "verdict/others_view.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>

namespace quorient::fdi {
namespace {

/// Determinant of the information matrix: below it the axes lie almost in a plane.
constexpr double least_determinant = 1e-3;

}  // namespace

OthersView::OthersView(const geometry::SensorCluster& cluster) : cluster_(cluster)
{
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        const AxisMask mask = cluster.axes_of(cluster.instrument[axis]);
        if (std::find(instruments_.begin(), instruments_.end(), mask) == instruments_.end()) instruments_.push_back(mask);
    }
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        const AxisMask own = cluster.axes_of(cluster.instrument[axis]);
        for (const AxisMask other : instruments_) {
            if (other == own) continue;
            add(own | other);
            pairs_[axis].push_back(estimate_without(own | other));
        }
        add(own);
        add(axis_bit(axis));
        wider_[axis] = {estimate_without(own), estimate_without(axis_bit(axis))};
    }
    prepare(cluster.all());
}

void OthersView::add(AxisMask without)
{
    if (estimate_without(without) == estimates_.size()) estimates_.push_back({without, false, Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()});
}

std::size_t OthersView::estimate_without(AxisMask axes) const
{
    const auto found = std::find_if(estimates_.begin(), estimates_.end(), [&](const Estimate& one) { return one.without == axes; });
    return static_cast<std::size_t>(found - estimates_.begin());
}

/// The inverses change with the axes in use alone.
void OthersView::prepare(AxisMask used)
{
    used_ = used;
    for (Estimate& estimate : estimates_) {
        Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
        for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
            if (!has_axis(used & ~estimate.without, axis)) continue;
            const auto row = cluster_.axes.row(static_cast<Eigen::Index>(axis));
            information += row.transpose() * row;
        }
        estimate.spans = information.determinant() >= least_determinant;
        if (estimate.spans) estimate.inverse = information.inverse();
    }
}

void OthersView::update(const Measurement& measurement, AxisMask used)
{
    if (used != used_) prepare(used);
    std::array<Eigen::Vector3d, max_axes> part;
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis)
        part[axis] = has_axis(used, axis) ? Eigen::Vector3d(cluster_.axes.row(static_cast<Eigen::Index>(axis)).transpose() *
                                                            (measurement.increment[axis] / measurement.interval_s))
                                          : Eigen::Vector3d::Zero();
    Eigen::Vector3d whole = Eigen::Vector3d::Zero();
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) whole += part[axis];
    for (Estimate& estimate : estimates_) {
        if (!estimate.spans) continue;
        Eigen::Vector3d sum = whole;
        for (AxisMask rest = estimate.without; rest != 0; rest &= rest - 1) sum -= part[static_cast<std::size_t>(std::countr_zero(rest))];
        estimate.rate = estimate.inverse * sum;
    }
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) of_[axis] = range_of(axis);
}

OthersView::Range OthersView::range_of(std::size_t axis) const
{
    Range range;
    const auto row = cluster_.axes.row(static_cast<Eigen::Index>(axis));
    const auto consider = [&](const Estimate& estimate) {
        if (!estimate.spans) return;
        const double rate = row.dot(estimate.rate);
        range.low = range.known ? std::min(range.low, rate) : rate;
        range.high = range.known ? std::max(range.high, rate) : rate;
        range.known = true;
    };
    for (const std::size_t pair : pairs_[axis]) consider(estimates_[pair]);
    range.independent = range.known && std::ranges::all_of(pairs_[axis], [this](std::size_t pair) { return estimates_[pair].spans; });
    for (const std::size_t wider : wider_[axis])
        if (!range.known) consider(estimates_[wider]);
    return range;
}

}  // namespace quorient::fdi
