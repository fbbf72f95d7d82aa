#include "agreement.hpp"

#include "quorient/messages/left_out.hpp"
#include "quorient/messages/sample_time.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::voting {
namespace {

bool finite(const auto& values)
{
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

bool is_sound(const AttitudeState& sample)
{
    return is_attitude(sample.attitude) && is_attitude(sample.reset_rotation) && finite(sample.rate_rad_s) &&
           std::isfinite(sample.angle_sigma_rad) && sample.angle_sigma_rad >= 0 && is_sample_time(sample.sample_time_ns);
}

bool Agreement::agree(std::size_t a, const AttitudeState& of_a, std::size_t b, const AttitudeState& of_b, double sigma_limit) const
{
    if (((of_a.isolated_mask & ~left_out_mask(of_b)) | (of_b.isolated_mask & ~left_out_mask(of_a))) != 0) return false;
    const double sigma = std::hypot(std::min(of_a.angle_sigma_rad, sigma_limit), std::min(of_b.angle_sigma_rad, sigma_limit));
    const double gate_rad = agreement_rad_ + agreement_sigmas_ * sigma;
    return angle_between(of_a.attitude, of_b.attitude) <= (apart_.test(pair(a, b)) ? gate_rad / 2 : gate_rad);
}

void Agreement::remember(std::size_t a, const AttitudeState& of_a, std::size_t b, const AttitudeState& of_b, double sigma_limit)
{
    if (left_out_mask(of_a) == left_out_mask(of_b)) apart_.set(pair(a, b), !agree(a, of_a, b, of_b, sigma_limit));
}

void Agreement::forget(std::size_t lane)
{
    for (std::size_t other = 0; other < max_lanes; ++other) apart_.reset(pair(lane, other));
}

}  // namespace quorient::voting
