#include "cli/cluster_input.hpp"
#include "cli/program.hpp"
#include "cli/json_output.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/recording/csv_writer.hpp"
#include "quorient/simulation/simulated_instrument.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quorient::cli {

namespace {

struct SimulateOptions {
    std::string motion;
    ClusterChoice choice{"cone-4", ""};
    simulation::Coning coning;
    double half_angle_deg = 10;
    double frequency_hz = 1;
    std::vector<double> rate_deg_s{0, 0, 10};
    double bandwidth_hz = 1;
    double rms_deg_s = 10;
    double interval_s = 0.005;
    double duration_s = 20;
    std::uint64_t seed = 1;
    double quantum_rad = 0;
    std::string quantize;
    double noise_rad = 0;
    double range_deg_s = 2000;
    std::vector<std::string> faults;
    std::optional<double> at_s;
    bool json = false;
};

simulation::Motion motion_of(const SimulateOptions& options)
{
    const auto kind = [&]() -> simulation::Motion::Kind {
        if (options.motion == "coning") return options.coning;
        if (options.motion == "classic-coning") return simulation::ClassicConing{options.half_angle_deg * degree, options.frequency_hz};
        if (options.motion == "turn") return simulation::Turn{degree * Eigen::Vector3d::Map(options.rate_deg_s.data())};
        if (options.motion == "random") return simulation::RandomMotion(options.bandwidth_hz, options.rms_deg_s * degree, options.seed);
        return simulation::Rest{};
    };
    const auto motion = simulation::checked(kind());
    if (!motion) fail(motion.error());
    return *motion;
}

geometry::SensorCluster cluster_of(const SimulateOptions& options)
{
    auto cluster = load_cluster(options.choice);
    if (!cluster) fail(cluster.error());
    if (!(options.range_deg_s > 0)) fail(fmt::format("--range-deg-s must be above 0, got {}", options.range_deg_s));
    cluster->range.setConstant(options.range_deg_s * degree);
    return *cluster;
}

simulation::Scenario scenario_of(const SimulateOptions& options, const geometry::SensorCluster& cluster)
{
    simulation::Scenario scenario;
    scenario.motion = motion_of(options);
    scenario.interval_s = options.interval_s;
    scenario.duration_s = options.duration_s;
    scenario.seed = options.seed;
    scenario.noise_rad = options.noise_rad;
    scenario.quantum = options.quantum_rad;
    const auto quantize = simulation::parse_quantize(!options.quantize.empty() ? options.quantize
                                                     : options.quantum_rad > 0 ? "carry"
                                                                               : "none");
    if (!quantize) fail(fmt::format("--quantize: {}", quantize.error()));
    scenario.quantize = *quantize;
    for (const std::string& text : options.faults) {
        const auto fault = simulation::parse_fault(text);
        if (!fault) fail(fmt::format("--fault: {}", fault.error()));
        scenario.faults.push_back(*fault);
    }
    if (const auto checked = simulation::check(scenario, cluster); !checked) fail(checked.error());
    if (!(scenario.duration_s > 0)) fail(fmt::format("--duration must be above 0 s, got {}", scenario.duration_s));
    return scenario;
}

/// Attitude and rate at one time, and the exact increments over the interval that follows.
void print_state(const SimulateOptions& options, const simulation::Scenario& scenario, const geometry::SensorCluster& cluster)
{
    const double time_s = *options.at_s;
    if (!std::isfinite(time_s)) fail(fmt::format("--at must be a finite time in s, got {}", time_s));
    const Eigen::Quaterniond q = scenario.motion.attitude(time_s);
    const Eigen::Vector3d rate = scenario.motion.rate(time_s);
    const Eigen::Vector3d increment = scenario.motion.increment(time_s, scenario.interval_s);
    if (options.json) {
        const Eigen::Vector4d attitude(q.w(), q.x(), q.y(), q.z());
        fmt::print("{}\n", dump({{"time", time_s},
                                 {"attitude", vector_json(attitude)},
                                 {"rate", vector_json(rate)},
                                 {"interval", scenario.interval_s},
                                 {"body_increment", vector_json(increment)},
                                 {"increment", vector_json(geometry::AxisVector(cluster.axes * increment))}}));
        return;
    }
    fmt::print("time,truth_w,truth_x,truth_y,truth_z,rate_x,rate_y,rate_z,body_increment_x,body_increment_y,body_increment_z\n{:.17g}",
               time_s);
    for (const double value : {q.w(), q.x(), q.y(), q.z(), rate.x(), rate.y(), rate.z(), increment.x(), increment.y(), increment.z()})
        fmt::print(",{:.17g}", value);
    fmt::print("\n");
}

Json frame_json(const SensorFrame& frame, const TruthState& truth)
{
    Json increments = Json::array();
    for (std::size_t axis = 0; axis < frame.axis_count; ++axis) {
        const bool valid = has_axis(frame.valid_mask, axis);
        increments.push_back(valid ? Json(frame.increment[axis]) : Json());
    }
    return {{"time", static_cast<double>(frame.sample_time_ns) * 1e-9},
            {"increment", increments},
            {"truth", truth.attitude},
            {"faulty", axes_json(truth.faulty_mask)}};
}

void print_run(const SimulateOptions& options, const simulation::Scenario& scenario, const geometry::SensorCluster& cluster)
{
    simulation::SimulatedInstrument instrument(scenario, cluster, 0, SensorKind::gyro, 0);
    if (instrument.frame_count() == 0)
        fail(fmt::format("--duration {} s holds no frame: --interval is {} s", scenario.duration_s, scenario.interval_s));
    std::optional<recording::CsvWriter> csv;
    if (!options.json) csv.emplace(std::cout, cluster.size(), true);
    SensorFrame frame;
    TruthState truth;
    for (std::uint64_t sequence = 0; sequence < instrument.frame_count() && std::cout; ++sequence) {
        instrument.advance_to(sequence, frame, truth);
        if (csv) csv->write(frame, &truth);
        else std::cout << dump(frame_json(frame, truth)) << '\n';
    }
}

void run(const SimulateOptions& options)
{
    const auto cluster = cluster_of(options);
    const auto scenario = scenario_of(options, cluster);
    if (options.at_s) print_state(options, scenario, cluster);
    else print_run(options, scenario, cluster);
}

/// An option that only one motion understands: given with another, it would silently do nothing.
void of_motion(Option option, const std::shared_ptr<SimulateOptions>& options, const std::string& motion)
{
    option.in_group("Motion " + motion).when_given([options, motion, option] {
        if (!options->motion.empty() && options->motion != motion)
            fail(fmt::format("{} belongs to motion {}, not {}", option.name(), motion, options->motion));
    });
}

void add_motion_options(Verb& verb, const std::shared_ptr<SimulateOptions>& o)
{
    of_motion(verb.option("--k2", o->coning.k2, "rate about the coning axes, rad/s").shows_default(), o, "coning");
    of_motion(verb.option("--k3", o->coning.k3, "rate about body x, rad/s").shows_default(), o, "coning");
    of_motion(verb.option("--mu", o->coning.mu, "initial attitude; mu^2 + nu^2 = 1").shows_default(), o, "coning");
    of_motion(verb.option("--nu", o->coning.nu, "initial attitude").shows_default(), o, "coning");
    of_motion(verb.option("--half-angle-deg", o->half_angle_deg, "of the cone").within(settings::not_negative).shows_default(), o, "classic-coning");
    of_motion(verb.option("--frequency-hz", o->frequency_hz, "of the cone").within(settings::above_zero).shows_default(), o, "classic-coning");
    of_motion(verb.numbers("--rate-deg-s", o->rate_deg_s, 3, "body rate x,y,z"), o, "turn");
    of_motion(
        verb.option("--bandwidth-hz", o->bandwidth_hz, "highest frequency of the angles").within(settings::above_zero).shows_default(), o,
        "random");
    of_motion(
        verb.option("--rms-deg-s", o->rms_deg_s, "root mean square of the rate per axis").within(settings::not_negative).shows_default(), o,
        "random");
}

}  // namespace

void add_simulate(Program& program)
{
    auto verb = program.verb("simulate", "What a sensor cluster measures on a moving body, with the true attitude, as CSV.");
    verb.footer(
        "Each row is one interval: its end, the increment of every axis (rad), the true attitude at its end. An axis without a sample "
        "reads nan.\n"
        "Faults: axis=I (or instrument=NAME), kind=bias|ramp|scale|stuck|zero|rail|sign|nan|noise|oscillation|dropout|delay|spike, "
        "value=V,\n"
        "start=S, end=E, and frequency= or period= where the kind needs it; times in seconds.\n\n"
        "Example: the coning motion of paper 003 with the fault of its tables\n"
        "  quorient simulate coning --interval 0.1 --quantum 0.4848e-6 --quantize body-truncate --fault "
        "axis=1,kind=scale,value=0.8,start=10\n");
    const auto options = std::make_shared<SimulateOptions>();
    verb.option("motion", options->motion, "coning, classic-coning, rest, turn or random")
        .value_name("MOTION")
        .required()
        .one_of({"coning", "classic-coning", "rest", "turn", "random"});
    add_cluster_options(verb, options->choice);
    add_motion_options(verb, options);
    verb.option("--interval", options->interval_s, "between frames, s").within(settings::above_zero).shows_default();
    verb.option("--duration", options->duration_s, "s").within(settings::above_zero).shows_default();
    verb.option("--seed", options->seed, "of noise, random motion and random faults").shows_default();
    verb.option("--quantum", options->quantum_rad, "smallest step of an increment, rad").within(simulation::scenario_record(), "quantum_rad");
    verb.option("--quantize", options->quantize, "none, carry, truncate or body-truncate; carry where a quantum is given");
    verb.option("--noise-rad", options->noise_rad, "standard deviation of every increment, rad").within(simulation::scenario_record(), "noise_rad");
    verb.option("--range-deg-s", options->range_deg_s, "where kind=rail sticks").within(settings::above_zero).shows_default();
    verb.option("--fault", options->faults, "SPEC, repeatable").value_name("SPEC ...");
    verb.option("--at", options->at_s, "print the state at this time and the exact increments over the interval after it, instead");
    verb.flag("--json", options->json, "one JSON object per row");
    verb.run([options] { run(*options); });
}

}  // namespace quorient::cli
