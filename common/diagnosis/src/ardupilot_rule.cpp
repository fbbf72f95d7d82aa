#include "quorient/diagnosis/ardupilot_rule.hpp"

#include <numbers>

namespace quorient::diagnosis {
namespace {

constexpr double ardupilot_tolerated_rad_s = 5 * std::numbers::pi / 180;

}  // namespace

void ArduPilotRule::update(double time_s, std::span<const Eigen::Vector3d> rates)
{
    for (std::size_t gyro = 1; gyro < rates.size(); ++gyro) {
        const double difference = (rates[gyro] - rates.front()).norm();
        if (difference <= ardupilot_tolerated_rad_s) continue;
        if (!refusal_) refusal_ = Refusal{gyro, difference, time_s, time_s};
        refusal_->last_s = time_s;
    }
}

}  // namespace quorient::diagnosis
