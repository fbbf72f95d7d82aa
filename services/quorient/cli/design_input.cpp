#include "design_input.hpp"

#include "quorient/configuration/document.hpp"
#include "quorient/configuration/section.hpp"
#include "quorient/messages/units.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <filesystem>

namespace quorient::cli {

namespace {

using configuration::Section;
using settings::above_zero;
using settings::not_negative;

constexpr settings::Bounds any_angle{.lowest = -360, .highest = 360};
constexpr settings::Bounds up_to_right{.lowest = 0, .highest = 90};
constexpr std::uint32_t most = max_axes;

std::vector<double> angles(Section& section, const char* key)
{
    std::vector<double> values;
    section.numbers(key, values, any_angle);
    for (double& value : values) value *= degree;
    return values;
}

/// A direction as [x, y, z], of any length but 0.
Eigen::Vector3d direction(Section& section, const char* key)
{
    std::vector<double> parts{0, 0, 1};
    section.numbers(key, parts);
    const Eigen::Vector3d found = parts.size() == 3 ? Eigen::Vector3d(parts[0], parts[1], parts[2]) : Eigen::Vector3d::Zero();
    if (found.norm() > 0) return found.normalized();
    section.problem(key, "expected a direction [x, y, z] that is not zero");
    return Eigen::Vector3d::UnitZ();
}

design::Face parse_face(Section& section)
{
    design::Face face;
    section.require("normal");
    face.normal = direction(section, "normal");
    double tolerance_deg = 0;
    section.number("tolerance_deg", tolerance_deg, up_to_right, "deg");
    face.tolerance_rad = tolerance_deg * degree;
    std::uint32_t holds = most;
    section.whole("holds", holds, {.lowest = 1, .highest = most});
    face.holds = holds;
    face.turns_rad = angles(section, "turns_deg");
    section.finish();
    return face;
}

design::FaceMounting parse_faces(Section& section)
{
    design::FaceMounting mounting;
    section.require("faces");
    for (Section& face : section.sections("faces")) mounting.faces.push_back(parse_face(face));
    return mounting;
}

design::WedgeMounting parse_wedges(Section& section)
{
    design::WedgeMounting mounting;
    section.require("angles_deg");
    mounting.angles_rad = angles(section, "angles_deg");
    mounting.azimuths_rad = angles(section, "azimuths_deg");
    mounting.turns_rad = angles(section, "turns_deg");
    return mounting;
}

design::ConeMounting parse_cone(Section& section)
{
    std::optional<double> half_angle_deg;
    section.number("half_angle_deg", half_angle_deg, up_to_right, "deg");
    if (!half_angle_deg) return {};
    return {*half_angle_deg * degree};
}

design::SymmetricMounting parse_symmetry(Section& section)
{
    design::SymmetricMounting mounting;
    std::uint32_t order = 2;
    section.whole("order", order, {.lowest = 2, .highest = most});
    mounting.order = order;
    mounting.about = direction(section, "about");
    return mounting;
}

/// The sub-mapping of a mounting, by its kind.
design::Mounting parse_mounting(Section section)
{
    std::string kind = "free";
    section.text("kind", kind);
    design::Mounting mounting = design::FreeMounting{};
    if (kind == "cone") mounting = parse_cone(section);
    else if (kind == "right-angles") mounting = design::RightAngleMounting{};
    else if (kind == "faces") mounting = parse_faces(section);
    else if (kind == "wedges") mounting = parse_wedges(section);
    else if (kind == "symmetric") mounting = parse_symmetry(section);
    else if (kind == "mirror") mounting = design::SymmetricMounting{direction(section, "normal"), 2};
    else if (kind != "free")
        section.problem(
            "kind", fmt::format("unknown mounting '{}'; known are free, cone, right-angles, faces, wedges, symmetric and mirror", kind));
    section.finish();
    return mounting;
}

std::optional<design::Mounting> mounting_of_name(const std::string& name)
{
    if (name == "free") return design::FreeMounting{};
    if (name == "cone") return design::ConeMounting{};
    if (name == "right-angles") return design::RightAngleMounting{};
    return std::nullopt;
}

design::Limit parse_limit(Section& section)
{
    design::Limit limit;
    std::uint32_t failures = 0;
    section.whole("failures", failures, {.lowest = 0, .highest = most});
    limit.failures = failures;
    section.number("trace", limit.trace, above_zero);
    section.number("volume", limit.volume, above_zero);
    section.number("condition", limit.condition, above_zero);
    section.finish();
    return limit;
}

design::SharedPart parse_shared(Section& section)
{
    design::SharedPart part;
    section.require("failures_per_h");
    section.require("instruments");
    section.number("failures_per_h", part.failures_per_h, above_zero);
    std::vector<double> instruments;
    section.numbers("instruments", instruments, {.lowest = 0, .highest = most - 1});
    for (const double index : instruments) {
        if (index != std::floor(index)) section.problem("instruments", fmt::format("expected numbers of instruments, got {}", index));
        part.instruments.push_back(static_cast<std::size_t>(index));
    }
    section.finish();
    return part;
}

design::Mission parse_mission(Section section)
{
    design::Mission mission;
    section.require("hours");
    section.number("hours", mission.hours, above_zero);
    section.number("axis_failures_per_h", mission.axis_failures_per_h, not_negative);
    section.number("instrument_failures_per_h", mission.instrument_failures_per_h, not_negative);
    for (Section& part : section.sections("shared")) mission.shared.push_back(parse_shared(part));
    std::vector<double> sizes{mission.least_fault_sigma, mission.most_fault_sigma};
    section.numbers("fault_sigma", sizes, above_zero);
    if (sizes.size() != 2 || sizes[0] > sizes[1]) section.problem("fault_sigma", "expected [least, most] in sigma");
    else std::tie(mission.least_fault_sigma, mission.most_fault_sigma) = std::pair(sizes[0], sizes[1]);
    std::uint32_t frames = mission.frames;
    section.whole("frames", frames, {.lowest = 1, .highest = 100'000});
    mission.frames = frames;
    section.text("method", mission.method);
    section.whole("trials", mission.trials);
    if (mission.trials == 0 || mission.trials > 10'000'000) section.problem("trials", "expected 1 to 10000000");
    section.finish();
    return mission;
}

/// Exactly one of axes, pairs, triads (none where `keep` alone is asked about).
void parse_instruments(Section& root, design::Brief& brief)
{
    const std::pair<const char*, unsigned> kinds[] = {{"axes", 1}, {"pairs", 2}, {"triads", 3}};
    bool known = false;
    for (const auto& [key, axes_each] : kinds) {
        if (!root.has(key)) continue;
        std::uint32_t count = 0;
        root.whole(key, count, {.lowest = 1, .highest = most});
        if (known) root.problem(key, "only one of axes, pairs and triads can be asked for");
        known = true;
        brief.instruments = count;
        brief.axes_each = axes_each;
    }
}

void parse_noise(Section& root, design::Brief& brief)
{
    if (!root.has("noise")) return;
    if (root.raw("noise").IsScalar()) {
        double one = 1;
        root.number("noise", one, above_zero);
        brief.noise = {one};
    } else {
        root.numbers("noise", brief.noise, above_zero);
    }
}

void parse_demands(Section& root, design::Brief& brief)
{
    double minimum_angle_deg = 0, mounting_error_deg = 0;
    root.number("minimum_angle_deg", minimum_angle_deg, up_to_right, "deg");
    root.number("mounting_error_deg", mounting_error_deg, up_to_right, "deg");
    brief.minimum_angle_rad = minimum_angle_deg * degree;
    brief.mounting_error_rad = mounting_error_deg * degree;
    root.whole("failures", brief.failures);
    std::uint32_t detectable = 0, isolable = 0;
    root.whole("detectable", detectable, {.lowest = 0, .highest = most});
    root.whole("isolable", isolable, {.lowest = 0, .highest = most});
    brief.detectable = detectable;
    brief.isolable = isolable;
    std::string fault = "axis";
    root.text("fault", fault);
    if (fault != "axis" && fault != "instrument") root.problem("fault", fmt::format("expected axis or instrument, got '{}'", fault));
    brief.instrument_faults = fault == "instrument";
    for (Section& limit : root.sections("limits")) brief.limits.push_back(parse_limit(limit));
}

/// Where each key of the file stands.
std::map<std::string, std::string> places_of(const std::string& file, const YAML::Node& document)
{
    std::map<std::string, std::string> places;
    for (const auto& entry : document)
        if (entry.first.IsScalar())
            places[entry.first.Scalar()] = fmt::format("{}:{}:{}", file, entry.second.Mark().line + 1, entry.second.Mark().column + 1);
    for (const char* kind : {"pairs", "triads"})
        if (places.contains(kind)) places["axes"] = places[kind];
    return places;
}

}  // namespace

tl::expected<BriefFile, std::string> load_brief(const std::string& file)
{
    const auto document = configuration::load_yaml(file);
    if (!document) return tl::unexpected(document.error().lines());
    configuration::Problems problems(file);
    Section root(*document, "", problems);
    BriefFile found;
    parse_instruments(root, found.brief);
    parse_noise(root, found.brief);
    parse_demands(root, found.brief);
    root.text("keep", found.keep);
    if (root.has("mounting") && root.raw("mounting").IsScalar()) {
        std::string name;
        root.text("mounting", name);
        if (const auto known = mounting_of_name(name)) found.brief.mounting = *known;
        else root.problem("mounting", fmt::format("unknown mounting '{}'; known are free, cone and right-angles, or a mapping with a kind", name));
    } else {
        found.brief.mounting = parse_mounting(root.section("mounting"));
    }
    if (root.has("mission")) found.brief.mission = parse_mission(root.section("mission"));
    root.finish();
    if (!problems.empty()) return tl::unexpected(problems.lines());
    found.place = places_of(file, *document);
    return found;
}

tl::expected<design::Mounting, std::string> load_mounting(const std::string& name_or_file)
{
    if (const auto known = mounting_of_name(name_or_file)) return *known;
    if (!std::filesystem::exists(name_or_file))
        return tl::unexpected(fmt::format("'{}' is no mounting and no file: known are free, cone and right-angles", name_or_file));
    const auto document = configuration::load_yaml(name_or_file);
    if (!document) return tl::unexpected(document.error().lines());
    configuration::Problems problems(name_or_file);
    const auto mounting = parse_mounting(Section(*document, "", problems));
    if (!problems.empty()) return tl::unexpected(problems.lines());
    return mounting;
}

}  // namespace quorient::cli
