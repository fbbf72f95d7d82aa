#include "vessel_input.hpp"

#include "quorient/runtime/yaml.hpp"

#include <fmt/format.h>
#include <optional>

namespace quorient::cli {
namespace {

using runtime::Section;

constexpr double default_threshold = 1e-3;  // of methods.md 001

std::optional<double> number_of(const YAML::Node& node)
{
    double value = 0;
    return node.IsScalar() && YAML::convert<double>::decode(node, value) ? std::optional(value) : std::nullopt;
}

/// `[[1, 2], [3, 4]]`: rows of numbers, all of one length.
void read_matrix(Section& section, const char* key, Eigen::MatrixXd& matrix)
{
    if (!section.has(key)) return;
    const YAML::Node rows = section.raw(key);
    const bool listed = rows.IsSequence() && rows.size() > 0 && rows[0].IsSequence() && rows[0].size() > 0;
    if (!listed) return section.problem(key, "expected a list of rows, each a list of numbers");
    Eigen::MatrixXd read(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows[0].size()));
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (!rows[row].IsSequence() || rows[row].size() != rows[0].size())
            return section.problem(key, fmt::format("row {} must have {} numbers like the first", row, rows[0].size()));
        for (std::size_t column = 0; column < rows[0].size(); ++column) {
            const auto value = number_of(rows[row][column]);
            if (!value) return section.problem(key, fmt::format("row {} column {} is not a number", row, column));
            read(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = *value;
        }
    }
    matrix = read;
}

/// A pole: a number, or `[real, imaginary]`, which stands for the conjugate pair.
bool read_pole(const YAML::Node& node, fdi::Poles& poles)
{
    if (const auto real = number_of(node)) {
        poles.emplace_back(*real, 0);
        return true;
    }
    if (!node.IsSequence() || node.size() != 2) return false;
    const auto real = number_of(node[0]);
    const auto imaginary = number_of(node[1]);
    if (!real || !imaginary) return false;
    poles.emplace_back(*real, *imaginary);
    poles.emplace_back(*real, -*imaginary);
    return true;
}

/// One list of poles for each channel, or a single one in it for all.
void read_poles(Section& section, const char* key, std::vector<fdi::Poles>& poles)
{
    if (!section.has(key)) return;
    const YAML::Node sets = section.raw(key);
    std::vector<fdi::Poles> read;
    bool listed = sets.IsSequence() && sets.size() > 0;
    for (std::size_t set = 0; listed && set < sets.size(); ++set) {
        read.emplace_back();
        listed = sets[set].IsSequence();
        for (std::size_t pole = 0; listed && pole < sets[set].size(); ++pole) listed = read_pole(sets[set][pole], read.back());
    }
    if (!listed) return section.problem(key, "expected one list of poles per channel, each pole a number or [real, imaginary] for a pair");
    poles = read;
}

void read_coefficients(Section section, simulation::VesselCoefficients& vessel)
{
    section.number("mass", vessel.mass, runtime::above_zero);
    section.number("inertia", vessel.inertia, runtime::above_zero);
    section.number("centre_of_mass_x", vessel.centre_of_mass_x);
    section.number("speed", vessel.speed);
    section.number("y_v", vessel.y_v);
    section.number("y_d", vessel.y_d);
    section.number("y_v_dot", vessel.y_v_dot);
    section.number("y_d_dot", vessel.y_d_dot);
    section.number("y_rudder", vessel.y_rudder);
    section.number("n_v", vessel.n_v);
    section.number("n_d", vessel.n_d);
    section.number("n_v_dot", vessel.n_v_dot);
    section.number("n_d_dot", vessel.n_d_dot);
    section.number("n_rudder", vessel.n_rudder);
    section.finish();
}

void read_plant(Section& root, VesselInput& input)
{
    if (root.has("vessel") && root.has("plant")) root.problem("plant", "give either a vessel's coefficients or a plant's matrices");
    simulation::VesselCoefficients coefficients;
    read_coefficients(root.section("vessel"), coefficients);
    const auto model = simulation::nomoto(coefficients);
    if (!model) return root.problem("vessel", model.error());
    input.model = *model;
    if (!root.has("plant")) return;
    Section plant = root.section("plant");
    for (const char* key : {"A", "B"}) plant.require(key);
    read_matrix(plant, "A", input.model.a);
    read_matrix(plant, "B", input.model.b);
    input.model.c = Eigen::MatrixXd::Identity(input.model.a.rows(), input.model.a.rows());
    read_matrix(plant, "C", input.model.c);
    plant.finish();
    const auto checked = fdi::check(fdi::LinearPlant{input.model.a, input.model.b, input.model.c});
    if (!checked) root.problem("plant", checked.error());
}

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
    Section root(*document, "", problems);
    read_plant(root, input);
    read_poles(root, "directional_poles", input.directional_poles);
    read_poles(root, "blind_poles", input.blind_poles);
    root.numbers("sigma", input.sigma, runtime::not_negative);
    root.number("model_error", input.model_error, {.lowest = 0, .highest = 1});
    root.number("false_alarm_probability", input.false_alarm_probability, runtime::probability);
    root.number("threshold", input.threshold, runtime::above_zero);
    root.finish();
    if (!problems.empty()) return tl::unexpected(problems.text());
    return input;
}

}  // namespace quorient::cli
