#include "quorient/system/plant.hpp"

#include <fmt/format.h>
#include <optional>

namespace quorient::system {

using runtime::Section;

namespace {

std::optional<double> number_of(const YAML::Node& node)
{
    double value = 0;
    return node.IsScalar() && YAML::convert<double>::decode(node, value) ? std::optional(value) : std::nullopt;
}

/// `[[1, 2], [3, 4]]`: rows of numbers, all of one length. @returns whether the matrix was there and could be read.
bool parse_matrix(Section& section, const char* key, Eigen::MatrixXd& matrix)
{
    if (!section.has(key)) return false;
    const auto refused = [&](std::string_view what) {
        section.problem(key, what);
        return false;
    };
    const YAML::Node rows = section.raw(key);
    const bool listed = rows.IsSequence() && rows.size() > 0 && rows[0].IsSequence() && rows[0].size() > 0;
    if (!listed) return refused("expected a list of rows, each a list of numbers");
    Eigen::MatrixXd read(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows[0].size()));
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (!rows[row].IsSequence() || rows[row].size() != rows[0].size())
            return refused(fmt::format("row {} must have {} numbers like the first", row, rows[0].size()));
        for (std::size_t column = 0; column < rows[0].size(); ++column) {
            const auto value = number_of(rows[row][column]);
            if (!value) return refused(fmt::format("row {} column {} is not a number", row, column));
            read(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = *value;
        }
    }
    matrix = read;
    return true;
}

bool parse_pole(const YAML::Node& node, fdi::Poles& poles)
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

simulation::VesselCoefficients parse_coefficients(Section section)
{
    simulation::VesselCoefficients vessel;
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
    return vessel;
}

bool parse_matrices(Section& parent, simulation::VesselModel& model)
{
    Section section = parent.section("plant");
    for (const char* key : {"A", "B"}) section.require(key);
    simulation::VesselModel read;
    const bool has_a = parse_matrix(section, "A", read.a);
    const bool has_b = parse_matrix(section, "B", read.b);
    const bool has_c = !section.has("C") || parse_matrix(section, "C", read.c);
    section.finish();
    if (!has_a || !has_b || !has_c) return false;
    if (read.c.size() == 0) read.c = Eigen::MatrixXd::Identity(read.a.rows(), read.a.rows());
    const auto checked = fdi::check(fdi::LinearPlant{read.a, read.b, read.c});
    if (checked) model = read;
    else parent.problem("plant", checked.error());
    return checked.has_value();
}

}  // namespace

bool parse_plant(Section& section, simulation::VesselModel& model)
{
    if (section.has("vessel") && section.has("plant"))
        section.problem("plant", "give either a vessel's coefficients or a plant's matrices");
    if (section.has("plant")) return parse_matrices(section, model);
    if (!section.has("vessel")) return true;
    const auto made = simulation::nomoto(parse_coefficients(section.section("vessel")));
    if (made) model = *made;
    else section.problem("vessel", made.error());
    return made.has_value();
}

void parse_poles(Section& section, const char* key, std::vector<fdi::Poles>& poles)
{
    if (!section.has(key)) return;
    const YAML::Node sets = section.raw(key);
    std::vector<fdi::Poles> read;
    bool listed = sets.IsSequence() && sets.size() > 0;
    for (std::size_t set = 0; listed && set < sets.size(); ++set) {
        read.emplace_back();
        listed = sets[set].IsSequence();
        for (std::size_t pole = 0; listed && pole < sets[set].size(); ++pole) listed = parse_pole(sets[set][pole], read.back());
    }
    if (!listed) return section.problem(key, "expected one list of poles per channel, each pole a number or [real, imaginary] for a pair");
    poles = read;
}

}  // namespace quorient::system
