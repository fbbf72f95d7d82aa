#include "field_attitude.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>

namespace quorient::studies {

Eigen::Vector3d Body::increment(const SensorFrame& frame, AxisMask used)
{
    const auto [found, fresh] = inverse_.try_emplace(used);
    if (fresh) {
        geometry::Axes h = cluster_.axes;
        for (std::size_t axis = 0; axis < cluster_.size(); ++axis)
            if (!has_axis(used, axis)) h.row(static_cast<Eigen::Index>(axis)).setZero();
        found->second = (h.transpose() * h).completeOrthogonalDecomposition().pseudoInverse() * h.transpose();
    }
    return found->second * Eigen::Map<const Eigen::VectorXd>(frame.increment.data(), cluster_.axes.rows());
}

void Attitude::add(const SensorFrame& frame)
{
    frames_.push_back(frame);
    left_out_.push_back(0);
    after_.push_back(rotation::Quaternion::Identity());
    integrate_from(frames_.size() - 1);
}

void Attitude::leave_out(const Exclusions& excluded_from)
{
    std::size_t first_changed = frames_.size();
    for (AxisMask rest = excluded_from.mask() & used_; rest != 0; rest &= rest - 1) {
        const auto axis = static_cast<std::size_t>(std::countr_zero(rest));
        for (std::size_t k = frames_.size(); k-- > 0 && frames_[k].sequence >= excluded_from[axis];) {
            if (has_axis(left_out_[k], axis)) break;
            left_out_[k] |= axis_bit(axis);
            first_changed = std::min(first_changed, k);
        }
    }
    integrate_from(first_changed);
}

void Attitude::integrate_from(std::size_t k)
{
    for (; k < frames_.size(); ++k) {
        const rotation::Quaternion before = k > 0 ? after_[k - 1] : rotation::Quaternion::Identity();
        const AxisMask used = used_ & frames_[k].valid_mask & ~left_out_[k];
        after_[k] = before * rotation::from_rotation_vector(body_.increment(frames_[k], used));
    }
}

}  // namespace quorient::studies
