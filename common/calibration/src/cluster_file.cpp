#include "quorient/calibration/cluster_file.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/codes.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

namespace quorient::calibration {
namespace {

constexpr std::array<std::string_view, 6> top_keys{"name", "kind", "interval_s", "origin", "motion_noise", "axes"};
constexpr std::array<std::string_view, 4> noise_keys{"along_s", "across_s", "level", "gated"};
constexpr std::array<std::string_view, 4> gated_keys{"along_s", "across_s", "axes", "rate"};
constexpr std::array<std::string_view, 9> axis_keys{"instrument", "direction",   "gain",        "bias_rad_s", "bias_spread_rad_s",
                                                    "sigma_rad",  "quantum_rad", "range_rad_s", "position_m"};

std::string triple(const std::array<double, 3>& values)
{
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", values[0], values[1], values[2]);
}

std::string noise_text(const CalibratedCluster& cluster)
{
    std::string text = fmt::format("{{along_s: {:.17g}, across_s: {:.17g}, level: {:.17g}", cluster.jitter_along_s, cluster.jitter_across_s,
                                   cluster.motion_level);
    if (const auto& gated = cluster.gated)
        text += fmt::format(", gated: {{along_s: {:.17g}, across_s: {:.17g}, axes: {:.17g}, rate: {:.17g}}}", gated->jitter_along_s,
                            gated->jitter_across_s, gated->axes_error, gated->rate_error);
    return text + "}";
}

/// Reads nodes and gathers what is wrong with them.
class Reading {
public:
    explicit Reading(std::string name) : name_(std::move(name)) {}

    void problem(const YAML::Mark& mark, std::string_view what)
    {
        const bool placed = mark.line >= 0;
        problems_.push_back(placed ? fmt::format("{}:{}:{}: {}", name_, mark.line + 1, mark.column + 1, what)
                                   : fmt::format("{}: {}", name_, what));
    }

    template <std::size_t Count>
    bool is_map_of(const YAML::Node& node, const std::array<std::string_view, Count>& keys)
    {
        if (!node.IsMap()) {
            problem(node.Mark(), fmt::format("expected keys and values; known are {}", fmt::join(keys, ", ")));
            return false;
        }
        for (const auto& entry : node) {
            const auto key = entry.first.IsScalar() ? entry.first.Scalar() : std::string("?");
            if (std::find(keys.begin(), keys.end(), key) == keys.end())
                problem(entry.first.Mark(), fmt::format("unknown key '{}'; known are {}", key, fmt::join(keys, ", ")));
        }
        return true;
    }

    std::optional<double> number(const YAML::Node& value)
    {
        double result = 0;
        if (value.IsScalar() && YAML::convert<double>::decode(value, result) && std::isfinite(result)) return result;
        problem(value.Mark(), "expected a finite number");
        return std::nullopt;
    }

    void number(const YAML::Node& map, const char* key, double& result, double lowest = -1e300, bool required = true)
    {
        const YAML::Node value = map[key];
        if (!value) {
            if (required) problem(map.Mark(), fmt::format("'{}' is missing", key));
            return;
        }
        const auto read = number(value);
        if (!read) return;
        if (*read < lowest) problem(value.Mark(), fmt::format("{} must be at least {:g}, got {:g}", key, lowest, *read));
        result = *read;
    }

    void triple(const YAML::Node& map, const char* key, std::array<double, 3>& result, bool required)
    {
        const YAML::Node value = map[key];
        if (!value) {
            if (required) problem(map.Mark(), fmt::format("'{}' is missing", key));
            return;
        }
        if (!value.IsSequence() || value.size() != 3) return problem(value.Mark(), fmt::format("{} must be [x, y, z]", key));
        for (std::size_t i = 0; i < 3; ++i) result[i] = number(value[i]).value_or(0);
    }

    std::string text(const YAML::Node& map, const char* key, std::size_t longest)
    {
        const YAML::Node value = map[key];
        if (!value) return {};
        if (value.IsScalar() && value.Scalar().size() <= longest) return value.Scalar();
        problem(value.Mark(), fmt::format("{} must be a text of at most {} bytes", key, longest));
        return {};
    }

    std::string report() const { return fmt::format("{}", fmt::join(problems_, "\n")); }
    bool good() const { return problems_.empty(); }

private:
    std::string name_;
    std::vector<std::string> problems_;
};

template <std::size_t Size>
void set_name(Name<Size>& name, std::string_view text)
{
    name = {};
    std::copy_n(text.begin(), std::min(text.size(), Size), name.begin());
}

/// The number of this instrument's name; a new name gets the next number.
std::uint8_t instrument_number(ClusterDescription& description, std::string_view name)
{
    for (std::uint8_t i = 0; i < description.instrument_count; ++i)
        if (text_of(description.instrument_name[i]) == name) return i;
    set_name(description.instrument_name[description.instrument_count], name);
    return description.instrument_count++;
}

void read_noise(Reading& reading, const YAML::Node& noise, CalibratedCluster& cluster)
{
    if (!noise || !reading.is_map_of(noise, noise_keys)) return;
    reading.number(noise, "along_s", cluster.jitter_along_s, 0);
    reading.number(noise, "across_s", cluster.jitter_across_s, 0);
    reading.number(noise, "level", cluster.motion_level, 0, false);
    const YAML::Node gated = noise["gated"];
    if (!gated || !reading.is_map_of(gated, gated_keys)) return;
    fdi::GatedNoise& terms = cluster.gated.emplace();
    reading.number(gated, "along_s", terms.jitter_along_s, 0);
    reading.number(gated, "across_s", terms.jitter_across_s, 0);
    reading.number(gated, "axes", terms.axes_error, 0);
    reading.number(gated, "rate", terms.rate_error, 0);
}

void read_axis(Reading& reading, const YAML::Node& node, std::size_t axis, CalibratedCluster& cluster)
{
    if (!reading.is_map_of(node, axis_keys)) return;
    auto& description = cluster.description;
    const std::string instrument = reading.text(node, "instrument", 16);
    if (instrument.empty()) reading.problem(node.Mark(), "'instrument' is missing");
    description.instrument[axis] = instrument_number(description, instrument);
    reading.triple(node, "direction", description.axis[axis], true);
    reading.triple(node, "position_m", description.position_m[axis], false);
    reading.number(node, "gain", cluster.gain[axis], 0.1);
    reading.number(node, "bias_rad_s", description.bias[axis]);
    reading.number(node, "bias_spread_rad_s", cluster.bias_spread_rad_s[axis], 0, false);
    reading.number(node, "sigma_rad", description.sigma[axis], 0);
    reading.number(node, "quantum_rad", description.quantum[axis], 0, false);
    reading.number(node, "range_rad_s", description.range[axis], 0, false);
}

void read_axes(Reading& reading, const YAML::Node& root, CalibratedCluster& cluster)
{
    const YAML::Node axes = root["axes"];
    if (!axes || !axes.IsSequence() || axes.size() < 3 || axes.size() > max_axes)
        return reading.problem(axes ? axes.Mark() : root.Mark(), fmt::format("'axes' must list 3 to {} axes", max_axes));
    cluster.description.axis_count = static_cast<std::uint8_t>(axes.size());
    for (std::size_t axis = 0; axis < axes.size(); ++axis) read_axis(reading, axes[axis], axis, cluster);
    if (!reading.good()) return;
    if (const auto valid = geometry::make_cluster(cluster.description); !valid) reading.problem(axes.Mark(), valid.error());
}

}  // namespace

std::string to_yaml(const CalibratedCluster& cluster)
{
    const auto& description = cluster.description;
    std::string text = fmt::format(
        "# A sensor cluster as calibrated. corrected increment = (raw - bias_rad_s * interval) / gain;\n"
        "# directions are unit vectors in the body frame, sigma_rad is of one corrected increment.\n"
        "name: {:?}\nkind: gyro\ninterval_s: {:.17g}\norigin: {:?}\nmotion_noise: {}\naxes:\n",
        text_of(description.name), description.interval_s, cluster.origin, noise_text(cluster));
    for (std::size_t axis = 0; axis < description.axis_count; ++axis) {
        text += fmt::format(
            "  - {{instrument: {:?}, direction: {}, gain: {:.17g},\n"
            "     bias_rad_s: {:.17g}, bias_spread_rad_s: {:.17g}, sigma_rad: {:.17g},\n"
            "     quantum_rad: {:.17g}, range_rad_s: {:.17g}, position_m: {}}}\n",
            text_of(description.instrument_name[description.instrument[axis]]), triple(description.axis[axis]), cluster.gain[axis],
            description.bias[axis], cluster.bias_spread_rad_s[axis], description.sigma[axis], description.quantum[axis],
            description.range[axis], triple(description.position_m[axis]));
    }
    return text;
}

tl::expected<CalibratedCluster, std::string> parse_cluster(const std::string& text, const std::string& name)
{
    Reading reading(name);
    CalibratedCluster cluster;
    try {
        const YAML::Node root = YAML::Load(text);
        if (reading.is_map_of(root, top_keys)) {
            cluster.description.kind = octet(SensorKind::gyro);
            const std::string kind = reading.text(root, "kind", 16);
            if (!kind.empty() && kind != "gyro") reading.problem(root["kind"].Mark(), fmt::format("kind must be gyro, got '{}'", kind));
            set_name(cluster.description.name, reading.text(root, "name", 32));
            cluster.origin = reading.text(root, "origin", 1000);
            reading.number(root, "interval_s", cluster.description.interval_s, 1e-9);
            read_noise(reading, root["motion_noise"], cluster);
            read_axes(reading, root, cluster);
        }
    } catch (const YAML::Exception& error) {  // yaml-cpp's only way to report a syntax error
        reading.problem(error.mark, error.msg);
    }
    if (!reading.good()) return tl::unexpected(reading.report());
    return cluster;
}

tl::expected<CalibratedCluster, std::string> load_cluster(const std::string& file)
{
    std::ifstream stream(file);
    if (!stream) return tl::unexpected(fmt::format("{}: cannot be opened for reading", file));
    std::ostringstream text;
    text << stream.rdbuf();
    return parse_cluster(text.str(), file);
}

}  // namespace quorient::calibration
