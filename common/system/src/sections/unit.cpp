#include "unit.hpp"

#include "matrix.hpp"
#include "quorient/messages/words.hpp"
#include "quorient/system/numbers.hpp"
#include "rotation.hpp"

#include <fmt/format.h>

namespace quorient::system {

using namespace configuration;

namespace {

std::vector<std::pair<std::string, SensorKind>> kind_words()
{
    std::vector<std::pair<std::string, SensorKind>> words;
    for (const auto& kind : unit_kinds) words.emplace_back(to_string(kind.code), kind.code);
    return words;
}

void read_axes(Section& section, UnitSection& unit)
{
    if (section.has("axes") && section.raw("axes").IsScalar()) return section.text("axes", unit.axes_file);
    Eigen::MatrixXd rows;
    if (!read_matrix(section, "axes", rows)) return;
    if (rows.cols() != 3 || rows.rows() < 3 || rows.rows() > static_cast<Eigen::Index>(max_axes))
        return section.problem("axes", fmt::format("expected 3 to {} axes, each [x, y, z]", max_axes));
    unit.axes = rows;
}

Rows<UnitSection> axes_row()
{
    return own<UnitSection>(
        {.name = "axes",
         .form = "list of [x, y, z], or the name of a file",
         .otherwise = "those of `layout`",
         .sentence = "Sensor axes as unit vectors in the body frame, used exactly as given. A file is one of `quorient design --out` or "
                     "`quorient calibrate --out`; its name counts from the folder of the system file."},
        read_axes, [](const UnitSection& unit) {
            if (!unit.axes_file.empty()) return to_node(unit.axes_file);
            return unit.axes ? matrix_node(*unit.axes) : YAML::Node{YAML::NodeType::Undefined};
        });
}

/// `{heading_deg: 30}`, or with `specific_force_m_s2`.
const Table<InitialAttitudeSection>& levelling_table()
{
    static const Table<InitialAttitudeSection> table{
        "",
        {required(value({.name = "heading_deg", .unit = "deg"}, &InitialAttitudeSection::heading_deg)),
         value({.name = "specific_force_m_s2", .unit = "m/s^2, in the body frame"}, &InitialAttitudeSection::specific_force_m_s2)}};
    return table;
}

void read_initial_attitude(Section& section, UnitSection& unit)
{
    const std::string key = "initial_attitude";
    if (!section.has(key)) return;
    const YAML::Node node = section.raw(key);
    if (node.IsMap() && !node["roll_deg"] && !node["pitch_deg"] && !node["yaw_deg"]) {
        auto levelling = section.section(key);
        return levelling_table().read(levelling, unit.initial_attitude);
    }
    if (!node.IsMap() && !node.IsSequence())
        return section.problem(key, fmt::format("expected a {}; or {{heading_deg: …}} to level by accelerometers", rotation_form));
    unit.initial_attitude.stated = read_rotation(section, key);
}

YAML::Node initial_attitude_node(const UnitSection& unit)
{
    const auto& attitude = unit.initial_attitude;
    if (attitude.stated) return rotation_node(*attitude.stated);
    return attitude.heading_deg ? levelling_table().write(attitude) : YAML::Node{YAML::NodeType::Undefined};
}

Rows<UnitSection> initial_attitude_row()
{
    return own<UnitSection>(
        {.name = "initial_attitude",
         .form = fmt::format("{}; or {{heading_deg: …}}, with specific_force_m_s2: [x, y, z] where no log has it", rotation_form),
         .otherwise = "the simulation's; of a log, the truth it holds",
         .sentence = "Attitude at the start of the first frame, body to reference. With `heading_deg`, roll and pitch come from what "
                     "accelerometers feel at rest."},
        read_initial_attitude, initial_attitude_node);
}

/// Keys of units whose axes are directions in space.
Rows<UnitSection> direction_rows()
{
    Rows<UnitSection> rows =
        value({.name = "layout", .otherwise = "`axes`, or what a log says", .sentence = "Axes by a name that `quorient layout` lists."},
              &UnitSection::layout);
    for (const auto& further : {axes_row(), initial_attitude_row()}) rows.insert(rows.end(), further.begin(), further.end());
    return rows;
}

Rows<UnitSection> with(Rows<UnitSection> rows, const Rows<UnitSection>& further)
{
    rows.insert(rows.end(), further.begin(), further.end());
    return rows;
}

Rows<UnitSection> range_row(const std::string& key, const std::string& unit, double UnitSection::*member)
{
    return value({.name = key,
                  .unit = unit,
                  .bounds = settings::not_negative,
                  .otherwise = "none stated",
                  .sentence = "An axis whose measurement reaches this is saturated; 0 = none stated."},
                 member);
}

Rows<UnitSection> vessel_rows()
{
    const Rows<UnitSection> rows = all_of(&UnitSection::plant, plant_rows());
    return with(rows, Table<UnitSection>{"",
                                         {value({.name = "channels",
                                                 .otherwise = "sway_velocity and yaw_rate of a vessel; channel0, … of a plant",
                                                 .sentence = "Names of what is measured, up to 15 characters each."},
                                                &UnitSection::channels),
                                          word<UnitSection, bool>({.name = "known_input", .sentence = "What drives the plant."}, "input",
                                                                  &UnitSection::rudder, {{"rudder", true}})}}
                          .rows());
}

template <SensorKind kind>
bool is(const UnitSection& unit)
{
    return unit.kind == kind;
}

}  // namespace

const Table<UnitSection>& unit_table()
{
    static const Table<UnitSection> table{
        "What is measured, and by which axes.",
        {value({.name = "id",
                .bounds = unit_ids,
                .sentence = "Number of the unit, unique in its domain."},
               &UnitSection::id),
         value({.name = "name", .otherwise = "unit and its id", .sentence = "Name of the unit, up to 31 characters."}, &UnitSection::name),
         word<UnitSection, SensorKind>({.name = "kind", .sentence = "What its sensors measure."}, "kind", &UnitSection::kind,
                                       kind_words())},
        {{"kind: gyro", "Gyros: detectors, integrators and voters.", is<SensorKind::gyro>,
          with(direction_rows(), range_row("range_deg_s", "deg/s", &UnitSection::range_deg_s))},
         {"kind: accelerometer", "Accelerometers: detectors only, since they give no attitude.", is<SensorKind::accelerometer>,
          with(direction_rows(), range_row("range_m_s2", "m/s^2", &UnitSection::range_m_s2))},
         {"kind: vessel_rates", "Rates of a vessel with a known input: detectors only, which are observers of a plant.",
          is<SensorKind::vessel_rates>, vessel_rows()}}};
    return table;
}

}  // namespace quorient::system
