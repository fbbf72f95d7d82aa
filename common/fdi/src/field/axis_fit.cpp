#include "field/axis_fit.hpp"

#include "field/frame_rules.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace quorient::fdi::field {
namespace {

/// What any fault may be, so that a fit over a few frames stays near "nothing wrong" [rad/s; 1; s]. Weak.
constexpr double prior_bias = 10;
constexpr double prior_error = 1;
constexpr double prior_delay = 0.1;

/// The prior's weight depends on the noise, which depends on the estimate.
constexpr int rounds = 2;
constexpr std::size_t frames_between_looks = 10;
constexpr double spike_noises = 8;
constexpr double spike_counts_as = 3;
constexpr std::size_t longest_spike = 3;  ///< frames

}  // namespace

void AxisFit::begin(const Eigen::Vector3d& direction, double least_noise)
{
    *this = AxisFit{};
    direction_ = direction;
    least_noise_ = least_noise;
}

void AxisFit::add(double measured, const Eigen::Vector3d& rate, const Eigen::Vector3d& acceleration)
{
    Parameters phi;
    phi << 1, rate, -direction_.dot(acceleration);
    double error = measured - direction_.dot(rate);
    const double surprise = error - estimate_.dot(phi);
    const double clip = spike_noises * std::sqrt(variance_ + phi.dot(covariance_ * phi));
    if (std::abs(surprise) <= clip) {
        if (run_ > 0 && run_ <= longest_spike) {
            spikes_ += run_;
            spike_sum_ += run_sum_;
        }
        run_ = 0;
        run_sum_ = 0;
    } else {
        run_sum_ += std::abs(surprise);
        // What lasts is no spike, but what the fit has yet to explain.
        if (++run_ <= longest_spike) error -= surprise - std::copysign(clip * spike_counts_as / spike_noises, surprise);
    }
    normal_ += phi * phi.transpose();
    moment_ += error * phi;
    squares_ += error * error;
    least_ = std::min(least_, measured);
    most_ = std::max(most_, measured);
    if (++frames_ % frames_between_looks == 0) solve();
}

void AxisFit::solve()
{
    Parameters prior;
    prior << 1 / (prior_bias * prior_bias), Eigen::Vector3d::Constant(1 / (prior_error * prior_error)), 1 / (prior_delay * prior_delay);
    const double least = least_noise_ * least_noise_;
    Covariance inverse;
    for (int round = 0; round < rounds; ++round) {
        Covariance information = normal_;
        information.diagonal() += std::max(least, std::isfinite(variance_) ? variance_ : least) * prior;
        inverse = information.ldlt().solve(Covariance::Identity());
        estimate_ = inverse * moment_;
        const double left = squares_ - 2 * estimate_.dot(moment_) + estimate_.dot(normal_ * estimate_);
        variance_ = std::max(least, left / static_cast<double>(frames_ - static_cast<std::size_t>(parameter_count)));
    }
    covariance_ = usual_colour * variance_ * inverse;

    const Eigen::Vector3d error = estimate_.segment<3>(gain_x);
    const Eigen::Matrix3d error_covariance = covariance_.block<3, 3>(gain_x, gain_x);
    const Eigen::Vector3d along = direction_ + error;
    const double across = std::max(0.0, (error_covariance.trace() - direction_.dot(error_covariance * direction_)) / 2);
    solution_.bias = {estimate_(bias), std::sqrt(covariance_(bias, bias))};
    solution_.gain = {direction_.dot(along), std::sqrt(direction_.dot(error_covariance * direction_))};
    solution_.delay = {estimate_(delay), std::sqrt(covariance_(delay, delay))};
    solution_.length = along.norm();
    solution_.turned = {std::acos(std::clamp(direction_.dot(along) / solution_.length, -1.0, 1.0)), std::sqrt(across)};
    solution_.noise = std::sqrt(variance_);
}

}  // namespace quorient::fdi::field
