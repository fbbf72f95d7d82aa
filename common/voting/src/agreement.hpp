#pragma once

#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/limits.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <array>
#include <bitset>
#include <cstddef>

namespace quorient::voting {

using rotation::angle_between;
using rotation::conjugate;
using rotation::is_attitude;
using rotation::no_rotation;
using rotation::product;

/// q_RB, body -> reference, Hamilton (w,x,y,z), as on the wire.
using Quaternion = rotation::Wxyz;

/// Everything a voter computes with is finite and in range.
bool is_sound(const AttitudeState& sample);

/// Which pairs of lanes agree: neither uses an axis that the other one has isolated, and their attitudes of one frame differ by at most
///     agreement_rad + agreement_sigmas * sqrt(sigma_a^2 + sigma_b^2),
/// and by at most half of that once they were apart (hysteresis).
///
/// Each sigma counts at most `sigma_limit`, the median over the lanes: a lane cannot widen its own gate by claiming a large one.
class Agreement {
public:
    Agreement(double agreement_rad, double agreement_sigmas) : agreement_rad_(agreement_rad), agreement_sigmas_(agreement_sigmas) {}

    bool agree(std::size_t a, const AttitudeState& of_a, std::size_t b, const AttitudeState& of_b, double sigma_limit) const;

    /// Remembers for the hysteresis how the pair stands now. Lanes that leave out different axes are not compared: the difference may be
    /// the fault that only one of them has found.
    void remember(std::size_t a, const AttitudeState& of_a, std::size_t b, const AttitudeState& of_b, double sigma_limit);

    /// The pairs of this lane start afresh.
    void forget(std::size_t lane);

private:
    static std::size_t pair(std::size_t a, std::size_t b) { return (a < b ? a : b) * max_lanes + (a < b ? b : a); }

    double agreement_rad_;
    double agreement_sigmas_;
    std::bitset<max_lanes * max_lanes> apart_;
};

}  // namespace quorient::voting
