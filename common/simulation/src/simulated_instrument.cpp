#include "quorient/messages/time.hpp"
#include "quorient/simulation/simulated_instrument.hpp"
#include "quorient/messages/meaning.hpp"

#include "counter_noise.hpp"

#include <fmt/format.h>
#include <array>
#include <cassert>
#include <cmath>

namespace quorient::simulation {
namespace {

constexpr std::array<std::string_view, 4> words_of_quantize{"none", "carry", "truncate", "body-truncate"};  // in the order of Quantize

double truncated(double increment, double quantum)
{
    return std::trunc(increment / quantum) * quantum;
}

std::array<double, 4> as_array(const Eigen::Quaterniond& q)
{
    return {q.w(), q.x(), q.y(), q.z()};
}

/// The cluster as this scenario makes it: what faults are measured against.
geometry::SensorCluster in_scenario(geometry::SensorCluster cluster, const Scenario& scenario)
{
    cluster.interval_s = scenario.interval_s;
    const double quantum = scenario.quantize == Quantize::none ? 0.0 : scenario.quantum;
    // Two roundings, each uniform over one quantum, bound a carried increment: variance quantum^2 / 6.
    const double sigma = std::sqrt(scenario.noise_rad * scenario.noise_rad + quantum * quantum / 6.0);
    cluster.quantum.setConstant(quantum);
    if (sigma > 0.0) cluster.sigma.setConstant(sigma);
    return cluster;
}

}  // namespace

std::vector<std::pair<std::string, Quantize>> quantize_words()
{
    std::vector<std::pair<std::string, Quantize>> words;
    for (std::size_t way = 0; way < words_of_quantize.size(); ++way) words.emplace_back(words_of_quantize[way], static_cast<Quantize>(way));
    return words;
}

tl::expected<Quantize, std::string> parse_quantize(std::string_view word)
{
    for (const auto& [known, way] : quantize_words())
        if (known == word) return way;
    return tl::unexpected(fmt::format("unknown quantisation '{}'; valid: {}", word, fmt::join(words_of_quantize, ", ")));
}

settings::Record<Scenario> scenario_record()
{
    static constexpr std::array<settings::Setting<Scenario>, 4> record{{
        {"quantum_rad", &Scenario::quantum, "rad", settings::not_negative,
         "The step in which a sensor counts [m/s for accelerometers]; 0 = none."},
        {"noise_rad", &Scenario::noise_rad, "rad", settings::not_negative,
         "Standard deviation of every increment [m/s for accelerometers], before it is quantised."},
        {"seed", &Scenario::seed, "", {}, "Seed of all that is random; the same seed gives the same frames."},
        {"duration_s", &Scenario::duration_s, "s", settings::not_negative, "Length of the simulation; 0 = without end."},
    }};
    return record;
}

tl::expected<void, std::string> check(const Scenario& scenario, const geometry::SensorCluster& cluster)
{
    if (!(std::isfinite(scenario.interval_s) && scenario.interval_s > 0.0))
        return tl::unexpected(fmt::format("the interval must be above 0 s, got {}", scenario.interval_s));
    if (const auto bounded = settings::check(scenario_record(), scenario); !bounded) return bounded;
    if (scenario.quantize != Quantize::none && scenario.quantum == 0.0)
        return tl::unexpected(std::string("quantisation needs a quantum above 0 rad"));
    if (scenario.faults.size() > FaultInjector::capacity)
        return tl::unexpected(fmt::format("{} faults given; at most {} fit", scenario.faults.size(), FaultInjector::capacity));
    const auto measured = in_scenario(cluster, scenario);
    for (const FaultSpec& fault : scenario.faults)
        if (auto resolved = resolve(fault, measured); !resolved) return tl::unexpected(std::move(resolved.error()));
    return {};
}

SimulatedInstrument::SimulatedInstrument(const Scenario& scenario, const geometry::SensorCluster& cluster, std::uint32_t unit,
                                         SensorKind kind, std::uint64_t epoch)
    : scenario_(scenario),
      cluster_(in_scenario(cluster, scenario)),
      faults_(cluster_, scenario.seed),
      epoch_(epoch),
      unit_(unit),
      kind_(kind)
{
    assert(check(scenario, cluster));
    for (const FaultSpec& fault : scenario.faults) {
        [[maybe_unused]] const auto added = faults_.add(fault);
        assert(added);
    }
}

void SimulatedInstrument::advance_to(std::uint64_t sequence, SensorFrame& frame, TruthState& truth)
{
    assert(sequence >= next_);
    frame.epoch = epoch_;
    frame.interval_s = scenario_.interval_s;
    frame.unit = unit_;
    frame.kind = octet(kind_);
    frame.axis_count = static_cast<std::uint8_t>(cluster_.size());
    while (next_ <= sequence) produce(next_++, frame);

    const double end_s = static_cast<double>(sequence + 1) * scenario_.interval_s;
    frame.sample_time_ns = nanoseconds(end_s);
    truth.epoch = epoch_;
    truth.sequence = sequence;
    truth.sample_time_ns = frame.sample_time_ns;
    truth.attitude = as_array(scenario_.motion.attitude(end_s));
    Eigen::Map<Eigen::Vector3d>(truth.rate_rad_s.data()) = scenario_.motion.rate(end_s);
    truth.unit = unit_;
    truth.faulty_mask = touched_;
    truth.attitude_known = 1;
}

void SimulatedInstrument::produce(std::uint64_t sequence, SensorFrame& frame)
{
    const double begin_s = static_cast<double>(sequence) * scenario_.interval_s;
    Eigen::Vector3d body = kind_ == SensorKind::accelerometer ? scenario_.motion.velocity_increment(begin_s, scenario_.interval_s)
                                                              : scenario_.motion.increment(begin_s, scenario_.interval_s);
    if (scenario_.quantize == Quantize::body_truncate)
        body = body.unaryExpr([this](double increment) { return truncated(increment, scenario_.quantum); });

    const geometry::AxisVector projected = cluster_.axes * body;
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        double increment = projected(static_cast<Eigen::Index>(axis));
        if (scenario_.noise_rad > 0.0) increment += scenario_.noise_rad * gaussian(scenario_.seed, axis, sequence);
        frame.increment[axis] = quantised(axis, increment);
    }
    frame.sequence = sequence;
    frame.valid_mask = cluster_.all();
    touched_ = faults_.apply(frame, begin_s);
    accumulator_.add(frame);
}

double SimulatedInstrument::quantised(std::size_t axis, double increment)
{
    switch (scenario_.quantize) {
        case Quantize::none:
        case Quantize::body_truncate:
            return increment;
        case Quantize::truncate:
            return truncated(increment, scenario_.quantum);
        case Quantize::carry:
            break;
    }
    remainder_[axis] += increment;
    const double whole = std::floor(remainder_[axis] / scenario_.quantum) * scenario_.quantum;
    remainder_[axis] -= whole;
    return whole;
}

std::array<double, 4> SimulatedInstrument::initial_attitude() const
{
    return as_array(scenario_.motion.attitude(0.0));
}

std::uint64_t SimulatedInstrument::frame_count() const
{
    if (scenario_.duration_s == 0.0) return std::numeric_limits<std::uint64_t>::max();
    return static_cast<std::uint64_t>(std::llround(scenario_.duration_s / scenario_.interval_s));
}

}  // namespace quorient::simulation
