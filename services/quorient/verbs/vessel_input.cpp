#include "vessel_input.hpp"

#include "quorient/runtime/yaml.hpp"
#include "quorient/system/plant.hpp"

namespace quorient::cli {
namespace {

constexpr double default_threshold = 1e-3;  // of methods.md 001

}  // namespace

fdi::ObserverSettings VesselInput::observers(fdi::ObserverScheme scheme) const
{
    fdi::ObserverSettings settings;
    settings.plant = {model.a, model.b, model.c};
    settings.scheme = scheme;
    settings.poles = scheme == fdi::ObserverScheme::directional ? directional_poles : blind_poles;
    settings.sigma = sigma;
    settings.model_error = model_error;
    settings.false_alarm_probability = false_alarm_probability;
    settings.threshold = threshold;
    if (!threshold && sigma.empty()) settings.threshold = default_threshold;
    return settings;
}

tl::expected<VesselInput, std::string> load_vessel(const std::string& file)
{
    VesselInput input;
    input.model = simulation::nomoto({}).value();
    if (file.empty()) return input;
    const auto document = runtime::load_yaml(file);
    if (!document) return tl::unexpected(document.error());
    runtime::Problems problems(file);
    runtime::Section root(*document, "", problems);
    system::parse_plant(root, input.model);
    system::parse_poles(root, "directional_poles", input.directional_poles);
    system::parse_poles(root, "blind_poles", input.blind_poles);
    root.numbers("sigma", input.sigma, runtime::not_negative);
    root.number("model_error", input.model_error, {.lowest = 0, .highest = 1});
    root.number("false_alarm_probability", input.false_alarm_probability, runtime::probability);
    root.number("threshold", input.threshold, runtime::above_zero);
    root.finish();
    if (!problems.empty()) return tl::unexpected(problems.text());
    return input;
}

}  // namespace quorient::cli
