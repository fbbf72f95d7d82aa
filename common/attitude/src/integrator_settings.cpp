#include "quorient/attitude/integrator_settings.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <cmath>

namespace quorient::attitude {
namespace {

constexpr double longest_history_frames = 250'000;

constexpr std::array<settings::Setting<IntegratorSettings>, 5> integrator_keys{{
    {"history_s", &IntegratorSettings::history_s, "s", settings::above_zero,
     "A verdict whose onset lies back no further than this is honoured: the frames since are integrated again."},
    {"rollback", &IntegratorSettings::rollback, "", {}, "With false, a verdict acts from the next frame on. For comparison only."},
    {"leave_out_suspects", &IntegratorSettings::leave_out_suspects, "", {}, "An axis is left out while it is suspected."},
    {"lost_after_s", &IntegratorSettings::lost_after_s, "s", settings::above_zero,
     "Without three trusted axes, the attitude is COASTING, and LOST after this time."},
    {"initial_sigma_rad", &IntegratorSettings::initial_sigma_rad, "rad", settings::not_negative,
     "Standard deviation of the attitude at the start, and of one that `quorient reset` sets."},
}};

}  // namespace

settings::Record<IntegratorSettings> integrator_record()
{
    return integrator_keys;
}

double longest_history_s(double interval_s)
{
    return longest_history_frames * interval_s;
}

std::string problem_of(const IntegratorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (cluster.kind != SensorKind::gyro) return "an attitude is integrated from gyros; this cluster is of another kind";
    if (!(cluster.interval_s > 0))
        return "the cluster's nominal interval must be above 0, got " + std::to_string(cluster.interval_s) + " s";
    if (const auto bounded = settings::check(integrator_record(), settings); !bounded) return bounded.error();
    if (settings.history_s > longest_history_s(cluster.interval_s))
        return "a history of " + std::to_string(settings.history_s) + " s at " + std::to_string(cluster.interval_s) +
               " s per frame is longer than 250000 frames; shorten history_s";
    const double norm = rotation::from_array(settings.initial_attitude).norm();
    if (!(std::abs(norm - 1) <= 1e-6)) return "initial_attitude must be a unit quaternion (w,x,y,z), its norm is " + std::to_string(norm);
    return {};
}

}  // namespace quorient::attitude
