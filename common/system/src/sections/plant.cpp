#include "quorient/system/plant.hpp"

#include "matrix.hpp"

#include <array>
#include <utility>

namespace quorient::system {

using namespace configuration;

namespace {

using fdi::LinearPlant;
using simulation::VesselCoefficients;

constexpr std::array<settings::Setting<VesselCoefficients>, 14> coefficients{{
    {"mass", &VesselCoefficients::mass, "", settings::above_zero, "Mass m. Not printed in the paper; an assumption."},
    {"inertia", &VesselCoefficients::inertia, "", settings::above_zero, "Moment of inertia I_z about the vertical axis; an assumption."},
    {"centre_of_mass_x", &VesselCoefficients::centre_of_mass_x, "", {}, "Centre of mass x_G, ahead of the origin; an assumption."},
    {"speed", &VesselCoefficients::speed, "", {}, "Forward speed u_0; an assumption."},
    {"y_v", &VesselCoefficients::y_v, "", {}, "Sway force by sway velocity."},
    {"y_d", &VesselCoefficients::y_d, "", {}, "Sway force by yaw rate."},
    {"y_v_dot", &VesselCoefficients::y_v_dot, "", {}, "Sway force by sway acceleration."},
    {"y_d_dot", &VesselCoefficients::y_d_dot, "", {}, "Sway force by yaw acceleration."},
    {"y_rudder", &VesselCoefficients::y_rudder, "", {}, "Sway force by rudder angle."},
    {"n_v", &VesselCoefficients::n_v, "", {}, "Yaw moment by sway velocity."},
    {"n_d", &VesselCoefficients::n_d, "", {}, "Yaw moment by yaw rate."},
    {"n_v_dot", &VesselCoefficients::n_v_dot, "", {}, "Yaw moment by sway acceleration."},
    {"n_d_dot", &VesselCoefficients::n_d_dot, "", {}, "Yaw moment by yaw acceleration."},
    {"n_rudder", &VesselCoefficients::n_rudder, "", {}, "Yaw moment by rudder angle."},
}};

Rows<LinearPlant> matrix_row(Key key, Eigen::MatrixXd LinearPlant::*member)
{
    key.form = "matrix [[…], …]";
    return own<LinearPlant>(
        key, [name = key.name, member](Section& section, LinearPlant& plant) { read_matrix(section, name, plant.*member); },
        [member](const LinearPlant& plant) {
            return (plant.*member).size() > 0 ? matrix_node(plant.*member) : YAML::Node{YAML::NodeType::Undefined};
        });
}

const Table<LinearPlant>& matrices_table()
{
    static const Table<LinearPlant> table{
        "A linear plant x' = A x + B u, y = C x, of up to 6 states and 6 channels.",
        {required(matrix_row({.name = "A", .sentence = "Matrix A, n x n [1/s]."}, &LinearPlant::a)),
         required(matrix_row({.name = "B", .sentence = "Matrix B, n x m."}, &LinearPlant::b)),
         matrix_row({.name = "C", .otherwise = "the identity", .sentence = "Matrix C, p x n: a row for each channel."}, &LinearPlant::c)}};
    return table;
}

const Table<VesselCoefficients>& coefficients_table()
{
    static const Table<VesselCoefficients> table{
        "A surface vessel at constant forward speed: the hydrodynamic coefficients of Nomoto's second-order model (paper 001, eqs 1-8).",
        {record<VesselCoefficients>(coefficients)}};
    return table;
}

bool read_pole(const YAML::Node& node, fdi::Poles& poles)
{
    double real = 0, imaginary = 0;
    if (node.IsScalar() && YAML::convert<double>::decode(node, real)) {
        poles.emplace_back(real, 0);
        return true;
    }
    if (!node.IsSequence() || node.size() != 2 || !node[0].IsScalar() || !node[1].IsScalar()) return false;
    if (!YAML::convert<double>::decode(node[0], real) || !YAML::convert<double>::decode(node[1], imaginary)) return false;
    poles.emplace_back(real, imaginary);
    poles.emplace_back(real, -imaginary);
    return true;
}

}  // namespace

Rows<PlantSection> plant_rows()
{
    return Table<PlantSection>{
        "",
        {part({.name = "vessel", .otherwise = "paper 001's", .sentence = "The plant as a vessel's coefficients."}, &PlantSection::vessel,
              coefficients_table()),
         part({.name = "plant", .otherwise = "a vessel", .sentence = "The plant as matrices."}, &PlantSection::plant, matrices_table())}}
        .rows();
}

tl::expected<simulation::VesselModel, PlantProblem> model_of(const PlantSection& section)
{
    if (section.vessel && section.plant)
        return tl::unexpected(PlantProblem{"plant", "give either a vessel's coefficients or a plant's matrices"});
    if (!section.plant) {
        const auto model = simulation::nomoto(section.vessel.value_or(VesselCoefficients{}));
        if (!model) return tl::unexpected(PlantProblem{"vessel", model.error()});
        return *model;
    }
    LinearPlant plant = *section.plant;
    if (plant.a.size() == 0 || plant.b.size() == 0) return tl::unexpected(PlantProblem{"plant", ""});
    if (plant.c.size() == 0) plant.c = Eigen::MatrixXd::Identity(plant.a.rows(), plant.a.rows());
    if (const auto checked = fdi::check(plant); !checked) return tl::unexpected(PlantProblem{"plant", checked.error()});
    return simulation::VesselModel{plant.a, plant.b, plant.c};
}

void read_poles(Section& section, const std::string& key, std::vector<fdi::Poles>& poles)
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
    if (listed) poles = read;
    else section.problem(key, "expected one list of poles per channel, each pole a number or [real, imaginary] for a pair");
}

YAML::Node poles_node(const std::vector<fdi::Poles>& poles)
{
    if (poles.empty()) return YAML::Node{YAML::NodeType::Undefined};
    YAML::Node sets{YAML::NodeType::Sequence};
    for (const auto& set : poles) {
        YAML::Node list{YAML::NodeType::Sequence};
        for (std::size_t pole = 0; pole < set.size(); ++pole) {
            if (set[pole].imag() == 0) {
                list.push_back(to_node(set[pole].real()));
                continue;
            }
            list.push_back(to_node(std::vector<double>{set[pole].real(), set[pole].imag()}));
            ++pole;  // its conjugate follows
        }
        sets.push_back(list);
    }
    sets.SetStyle(YAML::EmitterStyle::Flow);
    return sets;
}

}  // namespace quorient::system
