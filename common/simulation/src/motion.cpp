#include "quorient/simulation/motion.hpp"

#include "quadrature.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace quorient::simulation {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double gravity_m_s2 = 9.80665;  // standard gravity, ISO 80000-3

double sinc(double x)
{
    return x == 0.0 ? 1.0 : std::sin(x) / x;
}

double angular_frequency(const ClassicConing& cone)
{
    return 2.0 * std::numbers::pi * cone.frequency_hz;
}

Quaterniond attitude_at(const Rest&, double)
{
    return Quaterniond::Identity();
}

Quaterniond attitude_at(const Turn& turn, double t)
{
    const Vector3d half_angle = 0.5 * t * turn.rate_rad_s;
    const double half = half_angle.norm();
    const Vector3d vector = sinc(half) * half_angle;
    return {std::cos(half), vector.x(), vector.y(), vector.z()};
}

Quaterniond attitude_at(const Coning& m, double t)  // eq (46)
{
    const double c2 = std::cos(m.k2 * t / 2.0);
    const double s2 = std::sin(m.k2 * t / 2.0);
    const double c3 = std::cos(m.k3 * t / 2.0);
    const double s3 = std::sin(m.k3 * t / 2.0);
    return {m.mu * c2 * c3 + m.nu * s2 * s3, m.mu * c2 * s3 - m.nu * s2 * c3, m.mu * s2 * c3 + m.nu * c2 * s3,
            m.nu * c2 * c3 - m.mu * s2 * s3};
}

Quaterniond attitude_at(const ClassicConing& cone, double t)
{
    const double phase = angular_frequency(cone) * t;
    const double s = std::sin(cone.half_angle_rad / 2.0);
    return {std::cos(cone.half_angle_rad / 2.0), 0.0, s * std::cos(phase), s * std::sin(phase)};
}

Quaterniond attitude_at(const RandomMotion& random, double t)
{
    return random.attitude(t);
}

Vector3d rate_at(const Rest&, double)
{
    return Vector3d::Zero();
}
Vector3d rate_at(const Turn& turn, double)
{
    return turn.rate_rad_s;
}
Vector3d rate_at(const Coning& m, double t)
{
    return {m.k3, m.k2 * std::cos(m.k3 * t), -m.k2 * std::sin(m.k3 * t)};
}  // eq (47)

Vector3d rate_at(const ClassicConing& cone, double t)
{
    const double frequency = angular_frequency(cone);
    const double s = std::sin(cone.half_angle_rad / 2.0);
    return {-2.0 * s * s * frequency, -std::sin(cone.half_angle_rad) * frequency * std::sin(frequency * t),
            std::sin(cone.half_angle_rad) * frequency * std::cos(frequency * t)};
}

Vector3d rate_at(const RandomMotion& random, double t)
{
    return random.rate(t);
}

double highest_frequency(const Rest&)
{
    return 0.0;
}
double highest_frequency(const Turn& turn)
{
    return turn.rate_rad_s.norm();
}
double highest_frequency(const Coning& m)
{
    return std::abs(m.k2) + std::abs(m.k3);
}
double highest_frequency(const ClassicConing& cone)
{
    return 2.0 * angular_frequency(cone);
}
double highest_frequency(const RandomMotion& random)
{
    return random.highest_frequency_rad_s();
}

Vector3d increment_over(const Rest&, double, double)
{
    return Vector3d::Zero();
}
Vector3d increment_over(const Turn& turn, double, double h)
{
    return h * turn.rate_rad_s;
}

Vector3d increment_over(const Coning& m, double t, double h)  // eq (48); (2 k2/k3) sin(k3 h/2), not the printed sin(k3 h)
{
    const double swept = m.k2 * h * sinc(m.k3 * h / 2.0);
    const double middle = m.k3 * (t + h / 2.0);
    return {m.k3 * h, swept * std::cos(middle), -swept * std::sin(middle)};
}

Vector3d increment_over(const ClassicConing& cone, double t, double h)
{
    const double frequency = angular_frequency(cone);
    const double s = std::sin(cone.half_angle_rad / 2.0);
    const double swept = 2.0 * std::sin(cone.half_angle_rad) * std::sin(frequency * h / 2.0);
    const double middle = frequency * (t + h / 2.0);
    return {-2.0 * s * s * frequency * h, -swept * std::sin(middle), swept * std::cos(middle)};
}

Vector3d increment_over(const RandomMotion& random, double t, double h)
{
    return integrate([&](double time) { return random.rate(time); }, t, h, random.highest_frequency_rad_s());
}

std::string trouble(const Rest&)
{
    return {};
}

std::string trouble(const Turn& turn)
{
    return turn.rate_rad_s.allFinite() ? "" : "turn: the rate must be finite";
}

std::string trouble(const Coning& m)
{
    const double norm = m.mu * m.mu + m.nu * m.nu;
    if (!std::isfinite(m.k2) || !std::isfinite(m.k3)) return "coning: k2 and k3 must be finite [rad/s]";
    if (!(std::abs(norm - 1.0) <= 1e-9)) return fmt::format("coning: mu^2 + nu^2 must be 1, got {} (mu {}, nu {})", norm, m.mu, m.nu);
    return {};
}

std::string trouble(const ClassicConing& cone)
{
    if (!(cone.half_angle_rad >= 0.0 && cone.half_angle_rad <= std::numbers::pi))
        return "classic-coning: the half angle must lie in 0 … 180 deg";
    if (!(std::isfinite(cone.frequency_hz) && cone.frequency_hz >= 0.0)) return "classic-coning: the frequency must be 0 Hz or more";
    return {};
}

std::string trouble(const RandomMotion& random)
{
    return std::isfinite(random.highest_frequency_rad_s()) && random.highest_frequency_rad_s() > 0.0 && random.rate(0.0).allFinite()
               ? ""
               : "random: the bandwidth must be above 0 Hz and the rate 0 or more";
}

}  // namespace

Quaterniond Motion::attitude(double time_s) const
{
    return std::visit([&](const auto& kind) { return attitude_at(kind, time_s); }, kind_);
}

Vector3d Motion::rate(double time_s) const
{
    return std::visit([&](const auto& kind) { return rate_at(kind, time_s); }, kind_);
}

Vector3d Motion::increment(double begin_s, double duration_s) const
{
    return std::visit([&](const auto& kind) { return increment_over(kind, begin_s, duration_s); }, kind_);
}

Vector3d Motion::velocity_increment(double begin_s, double duration_s) const
{
    const auto specific_force = [&](double t) -> Vector3d { return attitude(t).conjugate() * Vector3d(0, 0, gravity_m_s2); };
    const double frequency = std::visit([](const auto& kind) { return highest_frequency(kind); }, kind_);
    return integrate(specific_force, begin_s, duration_s, frequency);
}

tl::expected<Motion, std::string> checked(Motion::Kind kind)
{
    auto problem = std::visit([](const auto& motion) { return trouble(motion); }, kind);
    if (!problem.empty()) return tl::unexpected(std::move(problem));
    return Motion(std::move(kind));
}

}  // namespace quorient::simulation
