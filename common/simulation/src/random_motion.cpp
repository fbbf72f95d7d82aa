#include "counter_noise.hpp"
#include "quorient/simulation/motion.hpp"

namespace quorient::simulation {

RandomMotion::RandomMotion(double bandwidth_hz, double rms_rad_s, std::uint64_t seed)
{
    // Equal shares of the rate's variance, one frequency per equal band: the rate's spectrum is flat up to the bandwidth.
    const double rate_amplitude_rad_s = rms_rad_s * std::sqrt(2.0 / harmonics);
    const double band_hz = bandwidth_hz / harmonics;
    for (std::size_t angle = 0; angle < 3; ++angle) {
        for (std::size_t k = 0; k < harmonics; ++k) {
            const double place = std::max(0.1, uniform(seed, 2 * angle, k));  // a frequency near 0 would make an endless turn
            const double frequency_rad_s = 2.0 * std::numbers::pi * band_hz * (static_cast<double>(k) + place);
            const double phase_rad = 2.0 * std::numbers::pi * uniform(seed, 2 * angle + 1, k);
            harmonic_[angle][k] = {rate_amplitude_rad_s / frequency_rad_s, frequency_rad_s, phase_rad};
        }
    }
    // The rate holds products of one angle rate with sines of two angles, whose own rates add to the frequency.
    const double peak_angle_rate_rad_s = harmonics * rate_amplitude_rad_s;
    highest_frequency_rad_s_ = 2.0 * std::numbers::pi * bandwidth_hz + 3.0 * peak_angle_rate_rad_s;
}

RandomMotion::AngleState RandomMotion::angles(double time_s) const
{
    AngleState state{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (std::size_t angle = 0; angle < 3; ++angle) {
        for (const Harmonic& h : harmonic_[angle]) {
            const double phase = h.frequency_rad_s * time_s + h.phase_rad;
            state.angle_rad(static_cast<Eigen::Index>(angle)) += h.amplitude_rad * std::sin(phase);
            state.angle_rate_rad_s(static_cast<Eigen::Index>(angle)) += h.amplitude_rad * h.frequency_rad_s * std::cos(phase);
        }
    }
    return state;
}

Eigen::Quaterniond RandomMotion::attitude(double time_s) const
{
    const Eigen::Vector3d angle = angles(time_s).angle_rad;
    return Eigen::AngleAxisd(angle(2), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(angle(1), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(angle(0), Eigen::Vector3d::UnitX());
}

Eigen::Vector3d RandomMotion::rate(double time_s) const
{
    const auto [angle, derivative] = angles(time_s);
    const double sin_x = std::sin(angle(0));
    const double cos_x = std::cos(angle(0));
    const double sin_y = std::sin(angle(1));
    const double cos_y = std::cos(angle(1));
    return {derivative(0) - derivative(2) * sin_y,  //
            derivative(1) * cos_x + derivative(2) * cos_y * sin_x, -derivative(1) * sin_x + derivative(2) * cos_y * cos_x};
}

}  // namespace quorient::simulation
