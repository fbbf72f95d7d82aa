#include "continuity.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace quorient::voting {
namespace {

constexpr double rounding_rad = 1e-9;

/// Beyond this a constant rate says nothing about where the old stream would be.
constexpr double extrapolation_s = 1.0;

Quaternion turned(const Quaternion& attitude, const std::array<double, 3>& rate_rad_s, double seconds)
{
    const Eigen::Vector3d angle = Eigen::Vector3d(rate_rad_s[0], rate_rad_s[1], rate_rad_s[2]) * seconds;
    if (angle.norm() == 0) return attitude;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle.norm(), angle.normalized()));
    return product(attitude, {turn.w(), turn.x(), turn.y(), turn.z()});
}

}  // namespace

bool Continuity::is_same(const Quaternion& a, const Quaternion& b)
{
    return angle_between(a, b) <= rounding_rad;
}

void Continuity::follow(const VotedAttitude& output)
{
    started_ = true;
    identity_ = identity_of(output);
    sample_time_ns_ = output.sample_time_ns;
    lane_ = output.primary_lane;
    counter_ = output.reset_counter;
    attitude_ = output.attitude;
    rotation_ = output.reset_rotation;
    rate_rad_s_ = output.rate_rad_s;
}

Continuity::Reset Continuity::next(const AttitudeState& sample, const AttitudeState* before) const
{
    if (!started_) return {sample.reset_counter, sample.reset_rotation, false};
    const Quaternion rotation = rotation_to(sample, before);
    if (is_same(rotation, no_rotation)) return {counter_, rotation_, false};
    return {counter_ + 1, rotation, true};
}

Quaternion Continuity::rotation_to(const AttitudeState& sample, const AttitudeState* before) const
{
    if (before != nullptr && sample.reset_counter - before->reset_counter <= 1) {
        const Quaternion change = product(before->attitude, conjugate(attitude_));
        return before->reset_counter == sample.reset_counter ? change : product(sample.reset_rotation, change);
    }  // a lane reports only the last of several resets
    const double seconds = static_cast<double>(sample.sample_time_ns - sample_time_ns_) * 1e-9;
    const bool same_stream = sample.epoch == identity_.epoch && seconds >= 0 && seconds <= extrapolation_s;
    const Quaternion expected = same_stream ? turned(attitude_, rate_rad_s_, seconds) : attitude_;
    return product(sample.attitude, conjugate(expected));
}

}  // namespace quorient::voting
