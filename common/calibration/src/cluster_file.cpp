#include "quorient/calibration/cluster_file.hpp"

#include "quorient/configuration/document.hpp"
#include "quorient/configuration/table.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

namespace quorient::calibration {

using namespace configuration;
namespace {

using settings::not_negative;

constexpr std::size_t longest_origin = 1000;
// As in the system file: names in a message end with a zero.
constexpr std::size_t longest_name = std::tuple_size_v<decltype(ClusterDescription::name)> - 1;
constexpr std::size_t longest_instrument = std::tuple_size_v<decltype(ClusterDescription::instrument_name)::value_type> - 1;

std::string triple(const std::array<double, 3>& values)
{
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", values[0], values[1], values[2]);
}

std::string noise_text(const CalibratedCluster& cluster)
{
    std::string text = fmt::format("{{along_s: {:.17g}, across_s: {:.17g}, level: {:.17g}", cluster.jitter.along_s, cluster.jitter.across_s,
                                   cluster.motion_level);
    if (const auto& gated = cluster.gated)
        text += fmt::format(", gated: {{along_s: {:.17g}, across_s: {:.17g}, axes: {:.17g}, rate: {:.17g}}}", gated->jitter_along_s,
                            gated->jitter_across_s, gated->axes_error, gated->rate_error);
    return text + "}";
}

/// A bias that was seen in one rest alone has no known spread.
std::string spread_text(double spread_rad_s)
{
    return spread_rad_s > 0 ? fmt::format("bias_spread_rad_s: {:.17g}, ", spread_rad_s) : std::string();
}

/// The number of this instrument's name; a new name gets the next number.
std::uint8_t instrument_number(ClusterDescription& description, std::string_view name)
{
    for (std::uint8_t i = 0; i < description.instrument_count; ++i)
        if (text_of(description.instrument_name[i]) == name) return i;
    copy_text(name, description.instrument_name[description.instrument_count]);
    return description.instrument_count++;
}

/// One of `axes`.
struct AxisSection {
    std::string instrument;
    std::array<double, 3> direction{};
    std::array<double, 3> position_m{};
    double gain = 1;
    double bias_rad_s = 0;
    double bias_spread_rad_s = 0;
    double sigma_rad = 0;
    double quantum_rad = 0;
    double range_rad_s = 0;
};

/// `motion_noise`.
struct NoiseSection {
    double along_s = 0;
    double across_s = 0;
    double level = 0;
    std::optional<fdi::MotionNoise> gated;
};

struct ClusterSection {
    std::string name;
    SensorKind kind = SensorKind::gyro;
    double interval_s = 0;
    std::string origin;
    std::optional<NoiseSection> motion_noise;
    std::vector<AxisSection> axes;
};

const Table<AxisSection>& axis_table()
{
    static constexpr std::array<settings::Setting<AxisSection>, 6> figures{{
        {"gain", &AxisSection::gain, "", {.lowest = 0.1}, "Gain of the raw measurement."},
        {"bias_rad_s", &AxisSection::bias_rad_s, "rad/s", {}, "Bias of the raw measurement."},
        {"sigma_rad", &AxisSection::sigma_rad, "rad", not_negative, "Standard deviation of one corrected increment."},
        {"bias_spread_rad_s", &AxisSection::bias_spread_rad_s, "rad/s", not_negative, "Standard deviation of the bias between recordings."},
        {"quantum_rad", &AxisSection::quantum_rad, "rad", not_negative, "The step in which the sensor counts; 0 = none."},
        {"range_rad_s", &AxisSection::range_rad_s, "rad/s", not_negative, "0 = none stated."},
    }};
    static const auto rows = record<AxisSection>(figures);
    static const Table<AxisSection> table{
        "One axis.",
        {required(value({.name = "instrument", .sentence = "Name, up to 15 bytes."}, &AxisSection::instrument)),
         required(value({.name = "direction", .sentence = "Unit vector in the body frame."}, &AxisSection::direction)),
         value({.name = "position_m", .unit = "m", .sentence = "Place in the body frame."}, &AxisSection::position_m),
         required(chosen(rows, {"gain", "bias_rad_s", "sigma_rad"})), chosen(rows, {"bias_spread_rad_s", "quantum_rad", "range_rad_s"})}};
    return table;
}

const Table<NoiseSection>& noise_table()
{
    using fdi::MotionNoise;
    static constexpr std::array<settings::Setting<MotionNoise>, 4> gated{{
        {"along_s", &MotionNoise::jitter_along_s, "s", not_negative, "Sampling jitter along the rate."},
        {"across_s", &MotionNoise::jitter_across_s, "s", not_negative, "Sampling jitter across it."},
        {"axes", &MotionNoise::axes_error, "", not_negative, "Error of the axes."},
        {"rate", &MotionNoise::rate_error, "", not_negative, "Error in proportion to the rate."},
    }};
    static constexpr std::array<settings::Setting<NoiseSection>, 3> figures{{
        {"along_s", &NoiseSection::along_s, "s", not_negative, "Sampling jitter along the rate."},
        {"across_s", &NoiseSection::across_s, "s", not_negative, "Sampling jitter across it."},
        {"level", &NoiseSection::level, "", not_negative, "Times what is usual; 0 = not known."},
    }};
    static const auto rows = record<NoiseSection>(figures);
    static const Table<MotionNoise> gated_table{"Terms of the gated sums.", {required(record<MotionNoise>(gated))}};
    static const Table<NoiseSection> table{
        "Errors of a moving array.",
        {required(chosen(rows, {"along_s", "across_s"})), chosen(rows, {"level"}),
         part({.name = "gated", .sentence = "Terms of the gated sums."}, &NoiseSection::gated, gated_table)}};
    return table;
}

/// A text that may be empty.
Rows<ClusterSection> text_row(Key key, std::string ClusterSection::*member)
{
    key.form = "text";
    const auto read = [name = key.name, member](Section& section, ClusterSection& cluster) {
        const YAML::Node node = section.raw(name);
        if (node.IsDefined() && !(node.IsScalar() && node.Scalar().empty())) section.text(name, cluster.*member);
    };
    return own<ClusterSection>(key, read, [member](const ClusterSection& cluster) { return to_node(cluster.*member); });
}

const Table<ClusterSection>& cluster_table()
{
    static constexpr std::array<settings::Setting<ClusterSection>, 1> figures{
        {{"interval_s", &ClusterSection::interval_s, "s", {.lowest = 1e-9}, "Interval between the recording's frames."}}};
    static const Table<ClusterSection> table{
        "A sensor cluster as calibrated.",
        {text_row({.name = "name", .sentence = "Name of the cluster, up to 31 bytes."}, &ClusterSection::name),
         word<ClusterSection, SensorKind>({.name = "kind", .sentence = "What it measures."}, "kind", &ClusterSection::kind,
                                          {{"gyro", SensorKind::gyro}}),
         required(record<ClusterSection>(figures)),
         text_row({.name = "origin", .sentence = "The log that it comes from."}, &ClusterSection::origin),
         part({.name = "motion_noise", .sentence = "Errors of a moving array."}, &ClusterSection::motion_noise, noise_table()),
         required(list<ClusterSection, AxisSection>({.name = "axes", .sentence = "3 to 24 axes."}, &ClusterSection::axes, axis_table(),
                                                    max_axes))}};
    return table;
}

void take(const AxisSection& section, std::size_t axis, CalibratedCluster& cluster)
{
    auto& description = cluster.description;
    description.instrument[axis] = instrument_number(description, section.instrument);
    description.axis[axis] = section.direction;
    description.position_m[axis] = section.position_m;
    description.bias[axis] = section.bias_rad_s;
    description.sigma[axis] = section.sigma_rad;
    description.quantum[axis] = section.quantum_rad;
    description.range[axis] = section.range_rad_s;
    cluster.gain[axis] = section.gain;
    cluster.bias_spread_rad_s[axis] = section.bias_spread_rad_s;
}

CalibratedCluster cluster_of(const ClusterSection& section)
{
    CalibratedCluster cluster;
    auto& description = cluster.description;
    description.kind = static_cast<std::uint8_t>(section.kind);
    description.interval_s = section.interval_s;
    copy_text(section.name, description.name);
    cluster.origin = section.origin;
    if (const auto& noise = section.motion_noise) {
        cluster.jitter.along_s = noise->along_s;
        cluster.jitter.across_s = noise->across_s;
        cluster.motion_level = noise->level;
        cluster.gated = noise->gated;
    }
    description.axis_count = static_cast<std::uint8_t>(section.axes.size());
    for (std::size_t axis = 0; axis < section.axes.size(); ++axis) take(section.axes[axis], axis, cluster);
    return cluster;
}

/// Mistakes that no key shows alone.
void check(const ClusterSection& section, const YAML::Node& document, Problems& problems)
{
    const auto refuse_longer = [&](const std::string& path, const std::string& text, std::size_t longest) {
        if (text.size() > longest) report(problems, document, path, fmt::format("must be a text of at most {} bytes", longest));
    };
    refuse_longer("name", section.name, longest_name);
    refuse_longer("origin", section.origin, longest_origin);
    for (std::size_t axis = 0; axis < section.axes.size(); ++axis)
        refuse_longer(fmt::format("axes[{}].instrument", axis), section.axes[axis].instrument, longest_instrument);
    if (section.axes.size() < 3) report(problems, document, "axes", fmt::format("must list 3 to {} axes", max_axes));
    if (!problems.empty()) return;
    if (const auto valid = geometry::make_cluster(cluster_of(section).description); !valid)
        report(problems, document, "axes", valid.error());
}

tl::expected<CalibratedCluster, std::string> read(const tl::expected<YAML::Node, Problems>& document, const std::string& name)
{
    if (!document) return tl::unexpected(document.error().lines());
    Problems problems{name};
    ClusterSection section;
    Section root{*document, "", problems};
    cluster_table().read(root, section);
    check(section, *document, problems);
    if (!problems.empty()) return tl::unexpected(problems.lines());
    return cluster_of(section);
}

}  // namespace

std::string to_yaml(const CalibratedCluster& cluster)
{
    const auto& description = cluster.description;
    std::string text = fmt::format(
        "# A sensor cluster as calibrated. corrected increment = (raw - bias_rad_s * interval) / gain;\n"
        "# directions are unit vectors in the body frame, sigma_rad is of one corrected increment.\n"
        "name: {:?}\nkind: gyro\ninterval_s: {:.17g}\norigin: {:?}\nmotion_noise: {}\naxes:\n",
        text_of(description.name).substr(0, longest_name), description.interval_s, cluster.origin, noise_text(cluster));
    for (std::size_t axis = 0; axis < description.axis_count; ++axis) {
        text += fmt::format(
            "  - {{instrument: {:?}, direction: {}, gain: {:.17g},\n"
            "     bias_rad_s: {:.17g}, {}sigma_rad: {:.17g},\n"
            "     quantum_rad: {:.17g}, range_rad_s: {:.17g}, position_m: {}}}\n",
            text_of(description.instrument_name[description.instrument[axis]]).substr(0, longest_instrument), triple(description.axis[axis]),
            cluster.gain[axis], description.bias[axis], spread_text(cluster.bias_spread_rad_s[axis]), description.sigma[axis], description.quantum[axis],
            description.range[axis], triple(description.position_m[axis]));
    }
    return text;
}

tl::expected<CalibratedCluster, std::string> parse_cluster(const std::string& text, const std::string& name)
{
    return read(parse_yaml(text, name), name);
}

tl::expected<CalibratedCluster, std::string> load_cluster(const std::string& file)
{
    return read(load_yaml(file), file);
}

}  // namespace quorient::calibration
