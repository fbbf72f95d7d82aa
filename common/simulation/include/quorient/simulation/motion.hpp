#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <variant>

namespace quorient::simulation {

/// The formal motion of paper 003, eqs (46)-(47): omega_B = (k3, k2 cos k3 t, -k2 sin k3 t). mu^2 + nu^2 = 1.
struct Coning {
    double k2 = 0.084;  ///< [rad/s]
    double k3 = 0.05;   ///< [rad/s]
    double mu = -0.6;
    double nu = 0.8;
};

/// The body x axis on a cone about the reference x axis, without spin: q = (cos a/2, 0, sin a/2 cos wt, sin a/2 sin wt).
struct ClassicConing {
    double half_angle_rad = 0;
    double frequency_hz = 0;
};

/// No rotation; body and reference axes coincide.
struct Rest {};

/// A constant rate about a fixed axis, from identity.
struct Turn {
    Eigen::Vector3d rate_rad_s{0, 0, 0.1};
};

/// Three successive rotations (about z, y, x) whose angles are sums of sinusoids with frequencies up to the bandwidth.
/// The attitude is therefore closed form, and the body rate has the stated root mean square per axis.
/// Not guaranteed: at large angles the *body* rate reaches beyond the bandwidth (the angles do not).
class RandomMotion {
public:
    static constexpr int harmonics = 8;  ///< for each angle

    RandomMotion(double bandwidth_hz, double rms_rad_s, std::uint64_t seed);

    Eigen::Quaterniond attitude(double time_s) const;
    Eigen::Vector3d rate(double time_s) const;

    /// Upper bound of the body rate's angular frequency content [rad/s]; what a quadrature has to resolve.
    double highest_frequency_rad_s() const { return highest_frequency_rad_s_; }

private:
    struct Harmonic {
        double amplitude_rad = 0;
        double frequency_rad_s = 0;
        double phase_rad = 0;
    };
    struct AngleState {
        Eigen::Vector3d angle_rad;
        Eigen::Vector3d angle_rate_rad_s;
    };
    AngleState angles(double time_s) const;

    std::array<std::array<Harmonic, harmonics>, 3> harmonic_{};
    double highest_frequency_rad_s_ = 0;
};

/// The true rotation of a body: a pure function of the scenario's time. All of it is truth; errors come later.
class Motion {
public:
    using Kind = std::variant<Rest, Turn, Coning, ClassicConing, RandomMotion>;

    Motion() = default;
    /// Each kind of motion is a motion.
    template <class OneKind>
    requires std::constructible_from<Kind, OneKind> &&(!std::same_as<std::remove_cvref_t<OneKind>, Motion>)Motion(OneKind&& kind)
        : kind_(std::forward<OneKind>(kind))  // NOLINT(google-explicit-constructor)
    {
    }

    /// q_RB, body -> reference, Hamilton, of unit norm.
    Eigen::Quaterniond attitude(double time_s) const;

    /// Body rate [rad/s].
    Eigen::Vector3d rate(double time_s) const;

    /// The integral of the body rate over [begin, begin + duration] [rad]. Closed form, eq (48) with (2 k2/k3) sin(k3 h/2) for Coning;
    /// for RandomMotion by Gauss-Legendre quadrature that resolves its highest frequency (error below 1e-15 of the value).
    Eigen::Vector3d increment(double begin_s, double duration_s) const;

    /// The integral over [begin, begin + duration] of the specific force of a body that does not accelerate: 9.80665 m/s^2 along
    /// the reference z axis, seen in the body frame [m/s].
    Eigen::Vector3d velocity_increment(double begin_s, double duration_s) const;

private:
    Kind kind_;
};

/// What is wrong with a motion's parameters (not finite, mu^2 + nu^2 not 1, a negative frequency …), or nothing.
tl::expected<Motion, std::string> checked(Motion::Kind kind);

}  // namespace quorient::simulation
