#include "vessel_input.hpp"

#include "quorient/configuration/document.hpp"
#include "quorient/configuration/table.hpp"
#include "quorient/system/plant.hpp"

namespace quorient::cli {
namespace {

constexpr double default_threshold = 1e-3;  // docs/methods/observers.md

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

namespace {

/// The file, apart from its plant.
struct VesselFile {
    VesselInput input;
    system::PlantSection plant;
    fdi::ObserverSettings observers;
};

const configuration::Table<VesselFile>& vessel_file_table()
{
    using configuration::all_of;
    using configuration::value;
    using fdi::ObserverSettings;
    const auto figures = configuration::record<ObserverSettings>(fdi::observer_record());
    static const configuration::Table<VesselFile> table{
        "A vessel, or another plant, and its observers.",
        {all_of(&VesselFile::plant, system::plant_rows()),
         all_of(&VesselFile::input, system::poles({.name = "directional_poles"}, &VesselInput::directional_poles)),
         all_of(&VesselFile::input, system::poles({.name = "blind_poles"}, &VesselInput::blind_poles)),
         all_of(&VesselFile::observers, value({.name = "sigma", .bounds = fdi::sigma_bounds}, &ObserverSettings::sigma)),
         all_of(&VesselFile::observers, configuration::chosen(figures, {"model_error", "threshold"})),
         all_of(&VesselFile::observers,
                value({.name = "false_alarm_probability", .bounds = settings::probability}, &ObserverSettings::false_alarm_probability))}};
    return table;
}

}  // namespace

tl::expected<VesselInput, std::string> load_vessel(const std::string& file)
{
    VesselFile read;
    if (!file.empty()) {
        const auto document = configuration::load_yaml(file);
        if (!document) return tl::unexpected(document.error().text());
        configuration::Problems problems(file);
        configuration::Section root(*document, "", problems);
        vessel_file_table().read(root, read);
        const auto model = system::model_of(read.plant);
        if (model) read.input.model = *model;
        else if (!model.error().what.empty()) configuration::report(problems, *document, model.error().key, model.error().what);
        if (!problems.empty()) return tl::unexpected(problems.text());
    } else {
        read.input.model = simulation::nomoto({}).value();
    }
    read.input.sigma = read.observers.sigma;
    read.input.model_error = read.observers.model_error;
    read.input.false_alarm_probability = read.observers.false_alarm_probability;
    read.input.threshold = read.observers.threshold;
    return read.input;
}

}  // namespace quorient::cli
