#include "cli/program.hpp"
#include "cli/json_output.hpp"
#include "verbs.hpp"
#include "vessel/vessel_plot.hpp"
#include "vessel/vessel_run.hpp"
#include "vessel/vessel_table.hpp"

#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <optional>

namespace quorient::cli {
namespace {

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

void print_csv(const VesselRow& row)
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

Json json_of(const VesselRow& row)
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

void run(const VesselOptions& options)
{
    const auto input = load_vessel(options.file);
    if (!input) fail(input.error());
    if (options.gains) return print_gains(options, *input);
    if (options.table) return options.json ? fmt::print("{}\n", dump(vessel_table_json())) : print_vessel_table();
    const auto scheme = fdi::parse_observer_scheme(options.scheme.empty() ? "blind" : options.scheme).value();
    const auto states = static_cast<std::size_t>(input->model.a.rows());
    const auto channels = static_cast<std::size_t>(input->model.c.rows());
    std::optional<OutputFile> plot_file;
    if (!options.plot_file.empty()) plot_file.emplace(options.plot_file, options.force);
    VesselPlot plot(std::string(to_string(scheme)), states, channels);
    bool first = !options.json;
    play(options, *input, scheme, [&](const VesselRow& row) {
        if (first) print_header(states, channels);
        first = false;
        if (options.json) std::cout << dump(json_of(row)) << '\n';
        else print_csv(row);
        if (plot_file) plot.add(row);
        return static_cast<bool>(std::cout);
    });
    std::cout.flush();
    if (plot_file) plot.write(*plot_file);
}

}  // namespace

void add_vessel(Program& program)
{
    auto verb = program.verb("vessel", "Faults of a vessel's rate sensors, found by observers (paper 001).");
    verb.footer(
        "Each row is one sample: the rudder, the true state, what each channel's observer did not expect, its metric, the decision.\n"
        "Without --fault the paper's run is played: 0.01 on channel 1 (yaw rate) during 20-30 s, on channel 0 (sway velocity) during 50-70 "
        "s;\n"
        "`--fault none` is the run without. Decisions are those of single samples; the detector process confirms and latches them.\n\n"
        "A file may hold (all of it optional):\n"
        "  vessel: {mass: 15, inertia: 8, centre_of_mass_x: 0.5, speed: 2, y_v: 5, ...}   # or, instead:\n"
        "  plant: {A: [[..]], B: [[..]], C: [[..]]}\n"
        "  directional_poles: [[along the fault, other], ..]     blind_poles: [[-3, -4]]     # a pair: [real, imaginary]\n"
        "  threshold: 1e-3     # or, instead: sigma: [2e-4], model_error: 0.05, false_alarm_probability: 1e-6\n\n"
        "Examples: the gains of the paper's two observers; the paper's figures\n  quorient vessel --gains --scheme directional\n"
        "  quorient vessel --scheme directional --plot vessel.svg > vessel.csv\n");
    const auto options = std::make_shared<VesselOptions>();
    const auto vessel = verb.option("--vessel", options->file, "YAML file of a vessel or any linear plant").value_name("FILE");
    verb.option("--scheme", options->scheme, "directional or blind; blind where not given (--gains: both)")
        .one_of({"directional", "blind"});
    const auto fault = verb.option("--fault", options->faults, "SPEC, repeatable; or none").value_name("SPEC ...");
    verb.option("--interval", options->interval_s, "between samples, s").within(settings::above_zero).shows_default();
    verb.option("--duration", options->duration_s, "s").within(settings::above_zero).shows_default();
    verb.option("--noise", options->noise, "standard deviation of every sample, in the channel's unit")
        .within(simulation::vessel_record(), "noise")
        .shows_default();
    verb.option("--seed", options->seed, "of the noise").shows_default();
    verb.option("--plot", options->plot_file, "the run as figures 4 to 6 of the paper").value_name("FILE.svg");
    add_force(verb, options->force);
    const auto gains = verb.flag("--gains", options->gains, "print A, B, C, every observer's gain and poles as JSON, instead");
    verb.flag("--table", options->table, "print the paper's run beside the figures recomputed from it: gains, window means, decisions")
        .in_place_of({gains, vessel, fault});
    verb.flag("--json", options->json, "one JSON object per row; one for the whole of --table");
    verb.run([options] { run(*options); });
}

}  // namespace quorient::cli
