#include "parse_source.hpp"

#include "parse_ros2.hpp"
#include "parse_vessel.hpp"
#include "quorient/attitude/levelling.hpp"
#include "quorient/geometry/layouts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

namespace quorient::system {

using runtime::Section;

namespace {

constexpr double degree = std::numbers::pi / 180;

const std::map<std::string, SensorKind> kinds{
    {"gyro", SensorKind::gyro}, {"accelerometer", SensorKind::accelerometer}, {"vessel_rates", SensorKind::vessel_rates}};

/// `axes: [[x, y, z], …]`
std::optional<geometry::Axes> parse_axes(Section& unit)
{
    const auto node = unit.raw("axes");
    if (!node.IsSequence() || node.size() == 0 || node.size() > max_axes) {
        unit.problem("axes", fmt::format("expected 3 to {} axes, each [x, y, z]", max_axes));
        return std::nullopt;
    }
    geometry::Axes axes(static_cast<Eigen::Index>(node.size()), 3);
    for (std::size_t i = 0; i < node.size(); ++i) {
        if (!node[i].IsSequence() || node[i].size() != 3) {
            unit.problem("axes", fmt::format("axis {} must be [x, y, z]", i));
            return std::nullopt;
        }
        for (std::size_t j = 0; j < 3; ++j) {
            try {
                axes(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = node[i][j].as<double>();
            } catch (const YAML::Exception&) {
                unit.problem("axes", fmt::format("axis {} has a component that is no number", i));
                return std::nullopt;
            }
        }
    }
    return axes;
}

tl::expected<geometry::SensorCluster, std::string> parse_cluster(Section& unit, const char*& key)
{
    if (unit.has("axes")) {
        key = "axes";
        const auto axes = parse_axes(unit);
        if (!axes) return geometry::layout("orthogonal-3");  // the problem is told; the rest of the file is still checked
        return geometry::make_cluster(*axes);
    }
    key = "layout";
    std::string layout;
    unit.text("layout", layout);
    return geometry::layout(layout);
}

simulation::Motion::Kind parse_motion(Section motion)
{
    std::string kind = "rest";
    motion.text("kind", kind);
    simulation::Motion::Kind result = simulation::Rest{};
    if (kind == "coning") {
        simulation::Coning coning;
        motion.number("k2", coning.k2, {.unit = "rad/s"});
        motion.number("k3", coning.k3, {.unit = "rad/s"});
        motion.number("mu", coning.mu);
        motion.number("nu", coning.nu);
        result = coning;
    } else if (kind == "classic-coning") {
        double half_angle_deg = 1, frequency_hz = 1;
        motion.number("half_angle_deg", half_angle_deg, {.lowest = 0, .highest = 180, .unit = "deg"});
        motion.number("frequency_hz", frequency_hz, runtime::not_negative);
        result = simulation::ClassicConing{half_angle_deg * degree, frequency_hz};
    } else if (kind == "turn") {
        std::vector<double> rate_deg_s{0, 0, 6};
        motion.numbers("rate_deg_s", rate_deg_s);
        if (rate_deg_s.size() == 3) result = simulation::Turn{Eigen::Vector3d(rate_deg_s[0], rate_deg_s[1], rate_deg_s[2]) * degree};
        else motion.problem("rate_deg_s", "expected three numbers [deg/s]");
    } else if (kind == "random") {
        double bandwidth_hz = 2, rms_deg_s = 30;
        std::uint64_t seed = 1;
        motion.number("bandwidth_hz", bandwidth_hz, runtime::above_zero);
        motion.number("rms_deg_s", rms_deg_s, runtime::not_negative);
        motion.whole("seed", seed);
        result = simulation::RandomMotion{bandwidth_hz, rms_deg_s * degree, seed};
    } else if (kind != "rest") {
        motion.problem("kind", fmt::format("unknown motion '{}'; known are rest, turn, coning, classic-coning and random", kind));
    }
    motion.finish();
    return result;
}

void parse_faults(Section& source, System& system)
{
    std::vector<std::string> texts;
    source.texts("faults", texts);
    for (const auto& text : texts) {
        if (const auto fault = simulation::parse_fault(text)) system.sensor.source.scenario.faults.push_back(*fault);
        else source.problem("faults", fault.error());
    }
}

/// A file that the system file names, from the folder that holds the system file: whoever starts a process, from wherever, means the same
/// one.
std::string beside(const System& system, const std::string& name)
{
    return name.empty() ? name : (std::filesystem::path(system.file).parent_path() / name).string();
}

void parse_log(Section& source, System& system)
{
    LogSettings log;
    if (source.has("file") && source.raw("file").IsSequence()) {
        source.texts("file", log.files);
        if (log.files.empty()) source.problem("file", "expected the name of a log, or a list of them");
    } else {
        source.text("file", log.files.emplace_back());
        source.require("file");
    }
    for (std::string& file : log.files) file = beside(system, file);
    // Where the file itself states the axes, it states their noise too.
    if (system.sensor.cluster) log.rest_s = 0;
    source.number("rest_s", log.rest_s, {.lowest = 0, .unit = "s"});
    std::string calibration;
    source.text("calibration", calibration);
    if (!calibration.empty()) {
        if (system.sensor.cluster) source.problem("calibration", "states the axes, as unit.layout or unit.axes do: keep one of them");
        if (auto loaded = calibration::load_cluster(beside(system, calibration))) log.calibration = std::move(*loaded);
        else source.problem("calibration", loaded.error());
    }
    source.number("from_s", log.from_s, runtime::not_negative);
    source.number("to_s", log.to_s, runtime::above_zero);
    system.sensor.source.log = std::move(log);
    // A simulation's file serves for the replay of its own recording: what only the simulation needs is passed over.
    for (const char* key : {"motion", "duration_s", "quantize"}) source.raw(key);
}

void parse_simulation(Section& source, System& system)
{
    auto& scenario = system.sensor.source.scenario;
    const auto motion = simulation::checked(parse_motion(source.section("motion")));
    if (motion) scenario.motion = *motion;
    else source.problem("motion", motion.error());
    source.number("duration_s", scenario.duration_s, {.lowest = 0, .unit = "s"});
    std::string quantize = scenario.quantum > 0 ? "carry" : "none";
    source.text("quantize", quantize);
    if (const auto way = simulation::parse_quantize(quantize)) scenario.quantize = *way;
    else source.problem("quantize", way.error());
}

/// A quaternion, or a mapping: levelled by what accelerometers feel at rest, given here or found in the log.
void parse_initial_attitude(Section& unit, SensorSettings& sensor)
{
    constexpr const char* key = "initial_attitude";
    if (!unit.has(key)) return;
    if (!unit.raw(key).IsMap()) {
        std::vector<double> attitude;
        unit.numbers(key, attitude);
        double norm = 0;
        for (const double component : attitude) norm += component * component;
        if (attitude.size() != 4 || std::abs(norm - 1) > 1e-6)
            unit.problem(key, "expected a unit quaternion [w, x, y, z], or {heading_deg: …} to level by accelerometers");
        else sensor.initial_attitude = {attitude[0], attitude[1], attitude[2], attitude[3]};
        return;
    }
    auto levelling = unit.section(key);
    double heading_deg = 0;
    std::vector<double> force_m_s2;
    levelling.require("heading_deg");
    levelling.number("heading_deg", heading_deg, {.unit = "deg"});
    levelling.numbers("specific_force_m_s2", force_m_s2);
    levelling.finish();
    if (!levelling.has("specific_force_m_s2")) {
        sensor.levelled_heading_rad = heading_deg * degree;
    } else if (force_m_s2.size() != 3) {
        levelling.problem("specific_force_m_s2", "expected three numbers, in the body frame");
    } else {
        const auto attitude = attitude::level({force_m_s2[0], force_m_s2[1], force_m_s2[2]}, heading_deg * degree);
        if (attitude) sensor.initial_attitude = attitude::to_array(*attitude);
        else levelling.problem("specific_force_m_s2", attitude.error());
    }
}

}  // namespace

void parse_unit(Section unit, System& system)
{
    unit.whole("id", system.unit, 0, 65'535);
    system.sensor.unit_name = fmt::format("unit {}", system.unit);
    unit.text("name", system.sensor.unit_name);
    std::string kind = "gyro";
    unit.text("kind", kind);
    if (kinds.contains(kind)) system.sensor.kind = kinds.at(kind);
    else unit.problem("kind", fmt::format("unknown kind '{}'; known are gyro, accelerometer and vessel_rates", kind));

    if (!system.has_attitude()) {
        parse_vessel_unit(unit, system);
        return unit.finish();
    }
    if (unit.has("layout") || unit.has("axes")) {
        const char* key = "layout";
        auto cluster = parse_cluster(unit, key);
        if (cluster) system.sensor.cluster = std::move(*cluster);
        else unit.problem(key, cluster.error());
    }
    double range_deg_s = 0;
    unit.number("range_deg_s", range_deg_s, {.lowest = 0, .unit = "deg/s"});
    if (system.sensor.cluster) system.sensor.cluster->range.setConstant(range_deg_s * degree);

    parse_initial_attitude(unit, system.sensor);
    unit.finish();
}

void parse_source(Section source, System& system)
{
    if (!system.has_attitude()) return parse_vessel_source(source, system);
    std::string kind = "simulation";
    source.text("kind", kind);
    source.whole("seed", system.sensor.source.scenario.seed);
    parse_faults(source, system);
    auto& scenario = system.sensor.source.scenario;
    double rate_hz = kind == "log" ? 62.5 : 200;
    source.number("rate_hz", rate_hz, {.lowest = 1, .highest = 20'000, .unit = "Hz"});
    system.interval_s = scenario.interval_s = 1 / rate_hz;
    source.number("quantum_rad", scenario.quantum, {.lowest = 0, .unit = "rad"});
    source.number("noise_rad", scenario.noise_rad, {.lowest = 0, .unit = "rad"});
    source.number("speed", system.sensor.source.speed, runtime::above_zero);
    if (kind == "log") parse_log(source, system);
    else if (kind == "simulation") parse_simulation(source, system);
    else if (kind == "ros2_imu") parse_ros2_source(source, system);
    else source.problem("kind", fmt::format("unknown source '{}'; known are simulation, log and ros2_imu", kind));

    auto& cluster = system.sensor.cluster;
    if (kind == "simulation") {
        if (system.sensor.levelled_heading_rad)
            source.problem("kind", "a simulation has no accelerometers to level by: state unit.initial_attitude.specific_force_m_s2");
        if (!cluster) source.problem("kind", "a simulation needs unit.layout or unit.axes");
        else if (const auto ok = simulation::check(scenario, *cluster); !ok) source.problem("kind", ok.error());
    }
    if (cluster) {
        cluster->sigma.setConstant(scenario.noise_rad);
        cluster->quantum.setConstant(scenario.quantum);
        cluster->interval_s = scenario.interval_s;
        cluster->kind = system.sensor.kind;
    }
    source.finish();
}

}  // namespace quorient::system
