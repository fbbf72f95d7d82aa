#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/fdi/observer_detector.hpp"
#include "study.hpp"
#include "vessel/vessel_input.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <random>

namespace quorient::studies {

namespace {

constexpr double interval_s = 0.01;
constexpr double noise = 2e-4;
constexpr double model_error = 0.05;
constexpr double false_alarm = 1e-5;  // per sample
constexpr double readmitted_at_s = 45;

/// How the limits are set, on a plant that is as the observers believe it to be, or not.
struct Rule {
    const char* name;
    double error;      ///< error of every entry of A and B of the plant, uniform within +-
    double allowed;    ///< what the observers allow for
    double threshold;  ///< 0: from noise and model error
};

constexpr Rule rules[] = {
    {"exact model, limits from noise", 0, 0, 0},
    {"5 % error, limits from noise and 5 %", model_error, model_error, 0},
    {"5 % error, limits from noise alone", model_error, 0, 0},
    {"5 % error, threshold 1e-3", model_error, 0, 1e-3},
};

struct Result {
    std::uint64_t samples = 0;
    std::uint64_t alarms = 0;              ///< samples of fault-free runs that are not healthy
    std::uint64_t false_isolations = 0;    ///< fault-free runs that end with a channel isolated
    std::array<std::uint64_t, 2> right{};  ///< runs that isolate the fault of the channel, and no other one
    std::array<std::vector<double>, 2> delay_s;
};

fdi::FaultMonitor monitor_of(const Rule& rule, fdi::ObserverScheme scheme)
{
    cli::VesselInput input = cli::load_vessel("").value();
    input.false_alarm_probability = false_alarm;
    input.sigma = {noise};
    input.model_error = rule.allowed;
    if (rule.threshold > 0) input.threshold = rule.threshold;
    auto detector = fdi::ObserverDetector::make(input.observers(scheme), interval_s).value();
    return fdi::FaultMonitor::make(std::move(detector), fdi::VerdictSettings{}, 2).value();
}

simulation::VesselScenario scenario_of(const Rule& rule, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> error(-rule.error, rule.error);
    simulation::VesselScenario scenario;
    scenario.model = simulation::nomoto({}).value();
    scenario.model.a = scenario.model.a.unaryExpr([&](double value) { return value * (1 + error(random)); }).eval();
    scenario.model.b = scenario.model.b.unaryExpr([&](double value) { return value * (1 + error(random)); }).eval();
    scenario.interval_s = interval_s;
    scenario.noise = noise;
    scenario.seed = seed;
    return scenario;
}

void play_healthy(const simulation::VesselScenario& scenario, fdi::FaultMonitor monitor, Result& result)
{
    simulation::SimulatedVessel vessel(scenario);
    SensorFrame frame;
    Eigen::VectorXd state;
    while (vessel.next(frame, state)) {
        monitor.assess(frame);
        ++result.samples;
        result.alarms += monitor.assessment().outcome != fdi::Outcome::healthy ? 1 : 0;
    }
    result.false_isolations += monitor.assess(frame).isolated_mask != 0 ? 1 : 0;
}

/// The paper's two faults; what was isolated is readmitted between them.
void play_faulty(simulation::VesselScenario scenario, fdi::FaultMonitor monitor, Result& result)
{
    scenario.faults = simulation::paper_faults();
    simulation::SimulatedVessel vessel(scenario);
    SensorFrame frame;
    Eigen::VectorXd state;
    std::array<double, 2> isolated_s{};  // by channel
    std::array<AxisMask, 2> named{};     // during the gyro's fault, during the other one
    isolated_s.fill(std::numeric_limits<double>::infinity());
    bool readmitted = false;
    while (vessel.next(frame, state)) {
        const double time = static_cast<double>(frame.sequence) * interval_s;
        if (!readmitted && time >= readmitted_at_s) {
            readmitted = true;
            monitor.readmit(0b11);
        }
        const AxisMask isolated = monitor.assess(frame).isolated_mask;
        const std::size_t channel = readmitted ? 0 : 1;
        named[readmitted ? 1 : 0] |= isolated;
        const double onset = scenario.faults[readmitted ? 1 : 0].start_s;
        if (has_axis(isolated, channel)) isolated_s[channel] = std::min(isolated_s[channel], time - onset);
    }
    for (const std::size_t channel : {std::size_t{0}, std::size_t{1}}) {
        const bool right = named[1 - channel] == axis_bit(channel) && isolated_s[channel] >= 0;
        result.right[channel] += right ? 1 : 0;
        if (right) result.delay_s[channel].push_back(isolated_s[channel]);
    }
}

double median(std::vector<double> values)
{
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void add_row(const Rule& rule, fdi::ObserverScheme scheme, const Result& result, std::uint64_t trials, Report& report)
{
    const double alarm_rate = static_cast<double>(result.alarms) / static_cast<double>(result.samples);
    const auto share = [&](std::uint64_t count) { return 100.0 * static_cast<double>(count) / static_cast<double>(trials); };
    fmt::format_to(std::back_inserter(report.text), "{:<38}{:<13}{:>10.2e}{:>13}{:>10.1f} %{:>8.2f}{:>10.1f} %{:>8.2f}\n", rule.name,
                   to_string(scheme), alarm_rate, result.false_isolations, share(result.right[1]), median(result.delay_s[1]),
                   share(result.right[0]), median(result.delay_s[0]));
    report.json["rules"].push_back({{"rule", rule.name},
                                    {"scheme", to_string(scheme)},
                                    {"false_alarms_per_sample", alarm_rate},
                                    {"runs_with_false_isolation", result.false_isolations},
                                    {"gyro_isolated_percent", share(result.right[1])},
                                    {"gyro_median_delay_s", median(result.delay_s[1])},
                                    {"sway_isolated_percent", share(result.right[0])},
                                    {"sway_median_delay_s", median(result.delay_s[0])}});
}

}  // namespace

Report vessel(const RunSettings& settings, const OnProgress& on_progress)
{
    Report report;
    report.text = fmt::format(
        "The vessel of paper 001, 80 s at 100 Hz, noise {:g}, allowed false alarms {:g} per sample; isolation confirmed by 2 of 3 "
        "samples.\n"
        "Runs without fault, then runs with the paper's two faults of 0.01: right channel and no other, and the median delay in s\n\n"
        "{:<38}{:<13}{:>10}{:>13}{:>12}{:>8}{:>12}{:>8}\n",
        noise, false_alarm, "limits", "scheme", "alarms", "false isol.", "gyro", "delay", "sway", "delay");
    std::size_t done = 0;
    for (const Rule& rule : rules) {
        for (const auto scheme : {fdi::ObserverScheme::directional, fdi::ObserverScheme::blind}) {
            Result result;
            for (std::uint64_t trial = 0; trial < settings.trials; ++trial) {
                const auto scenario = scenario_of(rule, settings.seed * 1'000'000 + trial);
                play_healthy(scenario, monitor_of(rule, scheme), result);
                play_faulty(scenario, monitor_of(rule, scheme), result);
                if (on_progress) on_progress(done * settings.trials + trial + 1, 2 * std::size(rules) * settings.trials);
            }
            ++done;
            add_row(rule, scheme, result, settings.trials, report);
        }
    }
    return report;
}

}  // namespace quorient::studies
