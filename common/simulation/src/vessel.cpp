#include "quorient/simulation/vessel.hpp"

#include "quorient/messages/meaning.hpp"

#include "counter_noise.hpp"
#include "quorient/messages/time.hpp"

#include <fmt/format.h>
#include <Eigen/LU>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace quorient::simulation {
namespace {

constexpr std::uint64_t noise_stream = 1'000'000;

tl::expected<void, std::string> check_size(const char* name, const Eigen::MatrixXd& matrix, Eigen::Index rows, Eigen::Index columns)
{
    if (matrix.rows() == rows && matrix.cols() == columns && matrix.allFinite()) return {};
    return tl::unexpected(fmt::format("{} must be {} x {} and finite, got {} x {}", name, rows, columns, matrix.rows(), matrix.cols()));
}

}  // namespace

tl::expected<VesselModel, std::string> nomoto(const VesselCoefficients& c)
{
    Eigen::Matrix2d mass, damping;
    mass << c.mass - c.y_v_dot, c.mass * c.centre_of_mass_x - c.y_d_dot, c.mass * c.centre_of_mass_x - c.n_v_dot, c.inertia - c.n_d_dot;
    damping << -c.y_v, c.mass * c.speed - c.y_d, -c.n_v, c.mass * c.centre_of_mass_x * c.speed - c.n_d;
    const Eigen::Vector2d rudder(c.y_rudder, c.n_rudder);
    if (!mass.allFinite() || !damping.allFinite() || !rudder.allFinite())
        return tl::unexpected(std::string("a coefficient of the vessel is not finite"));
    const Eigen::FullPivLU<Eigen::Matrix2d> lu(mass);
    if (!lu.isInvertible())
        return tl::unexpected(
            std::string("the vessel's mass matrix is singular: check mass, inertia, centre_of_mass_x and the added masses"));
    return VesselModel{-lu.solve(damping), lu.solve(rudder), Eigen::Matrix2d::Identity()};
}

std::vector<FaultSpec> paper_faults()
{
    FaultSpec gyro;
    gyro.kind = FaultKind::bias;
    gyro.axes = axis_bit(1);
    gyro.value = 0.01;
    gyro.start_s = 20;
    gyro.end_s = 30;
    FaultSpec accelerometer = gyro;
    accelerometer.axes = axis_bit(0);
    accelerometer.start_s = 50;
    accelerometer.end_s = 70;
    return {gyro, accelerometer};
}

geometry::SensorCluster channels_of(const VesselScenario& scenario)
{
    const Eigen::Index count = scenario.model.c.rows();
    geometry::SensorCluster cluster;
    cluster.axes = geometry::Axes::Zero(count, 3);
    cluster.sigma = geometry::AxisVector::Constant(count, scenario.noise * scenario.interval_s);
    cluster.quantum = geometry::AxisVector::Zero(count);
    cluster.range = geometry::AxisVector::Zero(count);
    cluster.interval_s = scenario.interval_s;
    cluster.kind = SensorKind::vessel_rates;
    for (std::size_t channel = 0; channel < static_cast<std::size_t>(count); ++channel) {
        cluster.instrument.push_back(channel);
        cluster.instrument_name.push_back(channel < scenario.channels.size() ? scenario.channels[channel]
                                                                             : fmt::format("channel{}", channel));
    }
    return cluster;
}

settings::Record<VesselScenario> vessel_record()
{
    static constexpr std::array<settings::Setting<VesselScenario>, 3> record{{
        {"noise", &VesselScenario::noise, "", settings::not_negative, "Standard deviation of every sample, in its channel's unit."},
        {"seed", &VesselScenario::seed, "", {}, "Seed of all that is random; the same seed gives the same frames."},
        {"duration_s", &VesselScenario::duration_s, "s", settings::not_negative, "How long it sails."},
    }};
    return record;
}

settings::Record<VesselScenario> rudder_record()
{
    static constexpr std::array<settings::Setting<VesselScenario>, 2> record{{
        {"amplitude_rad", &VesselScenario::rudder_rad, "rad", {}, "Amplitude of the sine that the rudder follows."},
        {"period_s", &VesselScenario::rudder_period_s, "s", settings::above_zero, "Period of that sine."},
    }};
    return record;
}

tl::expected<void, std::string> check(const VesselScenario& scenario)
{
    const Eigen::Index n = scenario.model.a.rows();
    const Eigen::Index channels = scenario.model.c.rows();
    if (n < 1) return tl::unexpected(std::string("A is empty"));
    if (channels < 1 || channels > static_cast<Eigen::Index>(max_axes))
        return tl::unexpected(fmt::format("C must have 1 to {} rows", max_axes));
    if (auto sized = check_size("A", scenario.model.a, n, n); !sized) return sized;
    if (auto sized = check_size("B", scenario.model.b, n, 1); !sized) return sized;
    if (auto sized = check_size("C", scenario.model.c, channels, n); !sized) return sized;
    if (!(scenario.interval_s > 0) || !std::isfinite(scenario.interval_s))
        return tl::unexpected(std::string("the interval must be above 0 s"));
    if (const auto bounded = settings::check(vessel_record(), scenario); !bounded) return bounded;
    if (const auto bounded = settings::check(rudder_record(), scenario); !bounded) return tl::unexpected("rudder: " + bounded.error());
    if (!(scenario.duration_s / scenario.interval_s < 1e9))
        return tl::unexpected(std::string("the duration must be from 0 s to a billion intervals"));
    if (!scenario.channels.empty() && scenario.channels.size() != static_cast<std::size_t>(channels))
        return tl::unexpected(fmt::format("{} names for {} channels", scenario.channels.size(), channels));
    for (const FaultSpec& fault : scenario.faults) {
        if (auto resolved = resolve(fault, channels_of(scenario)); !resolved) return tl::unexpected(resolved.error());
    }
    return {};
}

SimulatedVessel::SimulatedVessel(const VesselScenario& scenario)
    : scenario_(scenario),
      hold_(geometry::zero_order_hold(scenario.model.a, scenario.model.b, scenario.interval_s)),
      faults_(channels_of(scenario), scenario.seed),
      state_(Eigen::VectorXd::Zero(scenario.model.a.rows())),
      frames_(static_cast<std::uint64_t>(std::llround(scenario.duration_s / scenario.interval_s)) + 1)
{
    for (const FaultSpec& fault : scenario.faults) {
        [[maybe_unused]] const auto added = faults_.add(fault);
        assert(added && "the scenario is to be checked first");
    }
}

double SimulatedVessel::rudder_at(double time) const
{
    return scenario_.rudder_rad * std::sin(2 * std::numbers::pi * time / scenario_.rudder_period_s);
}

bool SimulatedVessel::next(SensorFrame& frame, Eigen::VectorXd& state)
{
    if (sequence_ >= frames_) return false;
    const Eigen::Index channels = scenario_.model.c.rows();
    const double time = time_s();
    const Eigen::VectorXd sample = scenario_.model.c * state_;
    frame = {};
    frame.sequence = sequence_;
    frame.sample_time_ns = nanoseconds(time);
    frame.interval_s = scenario_.interval_s;
    frame.kind = octet(SensorKind::vessel_rates);
    frame.axis_count = static_cast<std::uint8_t>(channels);
    frame.valid_mask = all_axes(static_cast<std::size_t>(channels));
    for (Eigen::Index channel = 0; channel < channels; ++channel) {
        double value = sample(channel);
        if (scenario_.noise > 0) {
            value += scenario_.noise * gaussian(scenario_.seed, noise_stream + static_cast<std::uint64_t>(channel), sequence_);
        }
        frame.increment[static_cast<std::size_t>(channel)] = value * scenario_.interval_s;
    }
    const double rudder = rudder_at(time);
    const bool lost = time >= scenario_.rudder_lost_from_s && time < scenario_.rudder_lost_to_s;
    frame.known_input[0] = lost ? std::numeric_limits<double>::quiet_NaN() : rudder;
    faulty_ = faults_.apply(frame, time);
    accumulator_.add(frame);

    state = state_;
    state_ = hold_.state * state_ + hold_.input * rudder;
    ++sequence_;
    return true;
}

}  // namespace quorient::simulation
