#include "vessel_run.hpp"

#include "cli/program.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::cli {

namespace {

simulation::VesselScenario scenario_of(const VesselOptions& options, const VesselInput& input)
{
    simulation::VesselScenario scenario;
    scenario.model = input.model;
    scenario.interval_s = options.interval_s;
    scenario.duration_s = options.duration_s;
    scenario.noise = options.noise;
    scenario.seed = options.seed;
    if (options.faults.empty()) scenario.faults = simulation::paper_faults();
    for (const std::string& text : options.faults) {
        if (text == "none") continue;
        const auto fault = simulation::parse_fault(text);
        if (!fault) fail(fmt::format("--fault: {}", fault.error()));
        scenario.faults.push_back(*fault);
    }
    if (const auto checked = simulation::check(scenario); !checked) fail(checked.error());
    return scenario;
}

/// Directional: C_i of eq (25). Blind: the largest residual of the channels that the observer does use.
double metric_of(const fdi::ObserverBank& bank, std::size_t channel)
{
    if (bank.scheme() == fdi::ObserverScheme::directional) return bank.metric(channel);
    double largest = 0;
    for (std::size_t other = 0; other < bank.channels(); ++other) {
        if (other != channel) largest = std::max(largest, std::abs(bank.residual(channel)(static_cast<Eigen::Index>(other))));
    }
    return largest;
}

}  // namespace

void play(const VesselOptions& options, const VesselInput& input, fdi::ObserverScheme scheme,
          const std::function<bool(const VesselRow&)>& see)
{
    simulation::SimulatedVessel vessel(scenario_of(options, input));
    const auto detector = fdi::ObserverDetector::make(input.observers(scheme), options.interval_s);
    if (!detector) fail(detector.error());
    const fdi::ObserverBank& bank = (*detector)->bank();
    SensorFrame frame;
    VesselRow row;
    row.residual.resize(bank.channels());
    row.metric.resize(bank.channels());
    while (vessel.next(frame, row.state)) {
        row.time_s = static_cast<double>(frame.sequence) * options.interval_s;
        row.rudder_rad = frame.known_input[0];
        row.sample =
            Eigen::Map<const Eigen::VectorXd>(frame.increment.data(), static_cast<Eigen::Index>(bank.channels())) / options.interval_s;
        (*detector)->assess({.identity = {0, frame.sequence},
                             .interval_s = frame.interval_s,
                             .increment = std::span(frame.increment).first(bank.channels()),
                             .valid = frame.valid_mask,
                             .known_input = frame.known_input},
                            row.assessment);
        for (std::size_t channel = 0; channel < bank.channels(); ++channel) {
            row.residual[channel] = bank.residual(channel);
            row.metric[channel] = metric_of(bank, channel);
        }
        if (!see(row)) return;
    }
}

}  // namespace quorient::cli
