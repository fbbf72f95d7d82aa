#include "quorient/attitude/integrator.hpp"

#include "engine.hpp"

#include <cmath>

namespace quorient::attitude {
namespace {

constexpr double longest_history_frames = 250'000;

std::string finding(const IntegratorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (cluster.kind != SensorKind::gyro) return "an attitude is integrated from gyros; this cluster is of another kind";
    if (!(cluster.interval_s > 0))
        return "the cluster's nominal interval must be above 0, got " + std::to_string(cluster.interval_s) + " s";
    if (!(settings.history_s > 0)) return "history_s must be above 0, got " + std::to_string(settings.history_s);
    if (!(settings.history_s / cluster.interval_s <= longest_history_frames))
        return "a history of " + std::to_string(settings.history_s) + " s at " + std::to_string(cluster.interval_s) +
               " s per frame is longer than 250000 frames; shorten history_s";
    if (!(settings.lost_after_s >= 0)) return "lost_after_s must not be negative, got " + std::to_string(settings.lost_after_s);
    if (!(settings.initial_sigma_rad >= 0))
        return "initial_sigma_rad must not be negative, got " + std::to_string(settings.initial_sigma_rad);
    const double norm = from_array(settings.initial_attitude).norm();
    if (!(std::abs(norm - 1) <= 1e-6)) return "initial_attitude must be a unit quaternion (w,x,y,z), its norm is " + std::to_string(norm);
    return {};
}

}  // namespace

tl::expected<Integrator, std::string> Integrator::make(const IntegratorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (const std::string wrong = finding(settings, cluster); !wrong.empty()) return tl::unexpected(wrong);
    auto update = make_update(settings.algorithm);
    if (!update) return tl::unexpected(update.error());

    const auto frames = static_cast<std::size_t>(std::ceil(settings.history_s / cluster.interval_s));
    const std::size_t capacity = frames + (*update)->memory() + 1;
    return Integrator(std::make_unique<Engine>(settings, std::move(*update), cluster, capacity));
}

Integrator::Integrator(std::unique_ptr<Engine> engine) : engine_(std::move(engine)) {}
Integrator::Integrator(Integrator&&) noexcept = default;
Integrator& Integrator::operator=(Integrator&&) noexcept = default;
Integrator::~Integrator() = default;

void Integrator::add(const SensorFrame& frame)
{
    engine_->add(frame);
}
void Integrator::apply(const FaultVerdict& verdict)
{
    engine_->apply(verdict);
}
bool Integrator::work()
{
    return engine_->work();
}
AttitudeState Integrator::state() const
{
    return engine_->state();
}
AttitudeState Integrator::publish()
{
    engine_->mark_published();
    return engine_->state();
}
std::uint64_t Integrator::history_too_short() const
{
    return engine_->history_too_short();
}
void Integrator::seed(const VotedAttitude& voted)
{
    engine_->seed(voted);
}

AxisMask Integrator::distrusted_in_seed() const
{
    return engine_->distrusted_in_seed();
}
void Integrator::let_go(AxisMask axes)
{
    engine_->let_go(axes);
}
bool Integrator::reset(const std::array<double, 4>& attitude, std::uint64_t sequence)
{
    return engine_->reset(from_array(attitude).normalized(), sequence);
}
void Integrator::begin_epoch(std::uint64_t epoch, const std::array<double, 4>& attitude)
{
    engine_->begin_epoch(epoch, from_array(attitude).normalized());
}

}  // namespace quorient::attitude
