#include "failure.hpp"
#include "json_output.hpp"
#include "quorient/fdi/observer_detector.hpp"
#include "svg_plot.hpp"
#include "verbs.hpp"
#include "vessel_input.hpp"

#include <fmt/format.h>
#include <bit>
#include <cmath>
#include <iostream>
#include <memory>

namespace quorient::cli {
namespace {

struct VesselOptions {
    std::string file;
    std::string scheme;
    std::vector<std::string> faults;
    double interval_s = 0.01;
    double duration_s = 80;
    double noise = 0;
    std::uint64_t seed = 1;
    std::string plot_file;
    bool gains = false;
    bool json = false;
};

/// One sample of the run.
struct Row {
    double time_s = 0;
    double rudder_rad = 0;
    Eigen::VectorXd state;
    std::vector<Eigen::VectorXd> residual;  ///< of each channel's observer
    std::vector<double> metric;             ///< likewise
    fdi::Assessment assessment;
};

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

std::string decision(const fdi::Assessment& assessment)
{
    switch (assessment.outcome) {
        case fdi::Outcome::warming_up:
            return "warming_up";
        case fdi::Outcome::healthy:
            return "healthy";
        case fdi::Outcome::suspect:
            return "suspect";
        case fdi::Outcome::isolated:
            return "isolated";
        case fdi::Outcome::ambiguous:
            return "ambiguous";
        case fdi::Outcome::refused:
            return "refused";
        case fdi::Outcome::blind:
            return "blind";
    }
    return "";
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

template <class See>
void play(const VesselOptions& options, const VesselInput& input, fdi::ObserverScheme scheme, See&& see)
{
    simulation::SimulatedVessel vessel(scenario_of(options, input));
    const auto detector = fdi::ObserverDetector::make(input.observers(scheme), options.interval_s);
    if (!detector) fail(detector.error());
    const fdi::ObserverBank& bank = (*detector)->bank();
    SensorFrame frame;
    Row row;
    row.residual.resize(bank.channels());
    row.metric.resize(bank.channels());
    while (vessel.next(frame, row.state)) {
        row.time_s = static_cast<double>(frame.sequence) * options.interval_s;
        row.rudder_rad = frame.known_input[0];
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

void print_header(std::size_t states, std::size_t channels)
{
    fmt::print("time,rudder");
    for (std::size_t k = 0; k < states; ++k) fmt::print(",state_{}", k);
    for (std::size_t observer = 0; observer < channels; ++observer) {
        for (std::size_t channel = 0; channel < channels; ++channel) fmt::print(",residual_{}_{}", observer, channel);
    }
    for (std::size_t observer = 0; observer < channels; ++observer) fmt::print(",metric_{}", observer);
    fmt::print(",decision,channels\n");
}

void print_csv(const Row& row)
{
    fmt::print("{:.17g},{:.17g}", row.time_s, row.rudder_rad);
    for (const double value : row.state) fmt::print(",{:.17g}", value);
    for (const auto& residual : row.residual) {
        for (const double value : residual) fmt::print(",{:.17g}", value);
    }
    for (const double value : row.metric) fmt::print(",{:.17g}", value);
    fmt::print(",{},", decision(row.assessment));
    for (std::size_t channel = 0, printed = 0; channel < row.metric.size(); ++channel) {
        if (has_axis(row.assessment.isolated, channel)) fmt::print("{}{}", printed++ == 0 ? "" : "+", channel);
    }
    fmt::print("\n");
}

Json json_of(const Row& row)
{
    Json residuals = Json::array();
    for (const auto& residual : row.residual) residuals.push_back(vector_json(residual));
    Json candidates = Json::array();
    for (std::size_t set = 0; set < row.assessment.candidate_count; ++set) candidates.push_back(axes_json(row.assessment.candidate[set]));
    return {{"time", row.time_s},
            {"rudder", row.rudder_rad},
            {"state", vector_json(row.state)},
            {"residual", residuals},
            {"metric", row.metric},
            {"decision", decision(row.assessment)},
            {"isolated", axes_json(row.assessment.isolated)},
            {"candidates", candidates}};
}

void add_gains(const fdi::ObserverBank& bank, Json& observers)
{
    for (std::size_t channel = 0; channel < bank.channels(); ++channel) {
        Json poles = Json::array();
        for (const auto& pole : bank.poles(channel)) poles.push_back(Json::array({pole.real(), pole.imag()}));
        observers.push_back(
            {{"scheme", to_string(bank.scheme())}, {"channel", channel}, {"K", matrix_json(bank.gain(channel))}, {"poles", poles}});
    }
}

/// The gains of the scheme asked for, or of both (of the directional one only where the plant allows it).
void print_gains(const VesselOptions& options, const VesselInput& input)
{
    Json observers = Json::array();
    for (const auto scheme : {fdi::ObserverScheme::directional, fdi::ObserverScheme::blind}) {
        if (!options.scheme.empty() && options.scheme != to_string(scheme)) continue;
        const auto bank = fdi::ObserverBank::make(input.observers(scheme), options.interval_s);
        if (!bank && (!options.scheme.empty() || scheme == fdi::ObserverScheme::blind)) fail(bank.error());
        if (bank) add_gains(*bank, observers);
        else fmt::print(stderr, "no directional gains: {}\n", bank.error());
    }
    const Json document{
        {"A", matrix_json(input.model.a)}, {"B", matrix_json(input.model.b)}, {"C", matrix_json(input.model.c)}, {"observers", observers}};
    fmt::print("{}\n", dump(document));
}

/// As the paper's figures 4 to 6: the motion, the two metrics, and what was decided.
class Plot {
public:
    Plot(const std::string& scheme, std::size_t states, std::size_t channels)
    {
        label(motion_, "the vessel", "state");
        label(metrics_, "metrics of the " + scheme + " scheme", "metric");
        label(decisions_, "isolated", "channel");
        for (std::size_t k = 0; k < states; ++k) motion_.series.push_back({fmt::format("state {}", k), {}, colour(k)});
        for (std::size_t k = 0; k < channels; ++k) {
            metrics_.series.push_back({fmt::format("channel {}", k), {}, colour(k)});
            decisions_.series.push_back({fmt::format("channel {}", k), {}, colour(k), false});
        }
    }

    void add(const Row& row)
    {
        for (std::size_t k = 0; k < motion_.series.size(); ++k)
            motion_.series[k].points.emplace_back(row.time_s, row.state(static_cast<Eigen::Index>(k)));
        for (std::size_t k = 0; k < metrics_.series.size(); ++k) {
            metrics_.series[k].points.emplace_back(row.time_s, row.metric[k]);
            if (has_axis(row.assessment.isolated, k)) decisions_.series[k].points.emplace_back(row.time_s, static_cast<double>(k));
        }
    }

    void write(const std::string& file) const { write_svg(file, {motion_, metrics_, decisions_}); }

private:
    static void label(Chart& chart, const std::string& title, const std::string& y_label)
    {
        chart.title = title;
        chart.x_label = "time, s";
        chart.y_label = y_label;
    }

    Chart motion_, metrics_, decisions_;
};

void run(const VesselOptions& options)
{
    const auto input = load_vessel(options.file);
    if (!input) fail(input.error());
    if (options.gains) return print_gains(options, *input);
    const auto scheme = fdi::parse_observer_scheme(options.scheme.empty() ? "blind" : options.scheme).value();
    const auto states = static_cast<std::size_t>(input->model.a.rows());
    const auto channels = static_cast<std::size_t>(input->model.c.rows());
    Plot plot(std::string(to_string(scheme)), states, channels);
    bool first = !options.json;
    play(options, *input, scheme, [&](const Row& row) {
        if (first) print_header(states, channels);
        first = false;
        if (options.json) std::cout << dump(json_of(row)) << '\n';
        else print_csv(row);
        if (!options.plot_file.empty()) plot.add(row);
        return static_cast<bool>(std::cout);
    });
    std::cout.flush();
    if (!options.plot_file.empty()) plot.write(options.plot_file);
}

}  // namespace

void add_vessel(CLI::App& program)
{
    auto* verb = program.add_subcommand("vessel", "Faults of a vessel's rate sensors, found by observers (paper 001).");
    verb->footer(
        "Each row is one sample: the rudder, the true state, what each channel's observer did not expect, its metric, the decision.\n"
        "Without --fault the paper's run is played: 0.01 on channel 1 (yaw rate) during 20-30 s, on channel 0 (sway velocity) during 50-70 "
        "s;\n"
        "`--fault none` is the run without. Decisions are those of single samples; the detector process confirms and latches them.\n\n"
        "A file may hold (all of it optional):\n"
        "  vessel: {mass: 15, inertia: 8, centre_of_mass_x: 0.5, speed: 2, y_v: 5, ...}   # or, instead:\n"
        "  plant: {A: [[..]], B: [[..]], C: [[..]]}\n"
        "  directional_poles: [[along the fault, other], ..]     blind_poles: [[-3, -4]]     # a pair: [real, imaginary]\n"
        "  threshold: 1e-3     # or, instead: sigma: [2e-4], model_error: 0.05, false_alarm_probability: 1e-6\n\n"
        "Example: the gains of the paper's two observers\n  quorient vessel --gains --scheme directional\n");
    const auto options = std::make_shared<VesselOptions>();
    verb->add_option("--vessel", options->file, "YAML file of a vessel or any linear plant")->option_text("FILE");
    verb->add_option("--scheme", options->scheme, "directional or blind; blind where not given (--gains: both)")
        ->check(CLI::IsMember({"directional", "blind"}));
    verb->add_option("--fault", options->faults, "SPEC, repeatable; or none")->allow_extra_args(false)->option_text("SPEC ...");
    verb->add_option("--interval", options->interval_s, "between samples, s")->capture_default_str();
    verb->add_option("--duration", options->duration_s, "s")->capture_default_str();
    verb->add_option("--noise", options->noise, "standard deviation of every sample, in the channel's unit")->capture_default_str();
    verb->add_option("--seed", options->seed, "of the noise")->capture_default_str();
    verb->add_option("--plot", options->plot_file, "the run as a figure")->option_text("FILE.svg");
    verb->add_flag("--gains", options->gains, "print A, B, C, every observer's gain and poles as JSON, instead");
    verb->add_flag("--json", options->json, "one JSON object per row");
    verb->callback([options] { run(*options); });
}

}  // namespace quorient::cli
