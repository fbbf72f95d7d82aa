#include "quorient/fdi/sensor_class.hpp"

#include "quorient/messages/units.hpp"

#include <array>
#include <utility>

namespace quorient::fdi {
namespace {

constexpr double degree_per_hour = degree / 3600;

/// Data of flights: biases differ by up to 3 deg/s, gains and cross-axis terms by up to 2.9 %, typically 1 %.
constexpr ClassFigures consumer{.bias_after_rest_rad_s = 0.15 * degree,
                                .bias_unknown_rad_s = 2.0 * degree,
                                .bias_calibrated_rad_s = 0.3 * degree,
                                .gain = 0.015,
                                .gain_calibrated = 0.002,
                                .bias_floor_rad_s = 0.12 * degree,
                                .gain_floor = 8e-4,
                                .bias_wander_rad_s_root_s = 0.005 * degree,
                                .largest_bias_rad_s = 8 * degree,
                                .largest_drift_rad_s = 3 * degree,
                                .largest_gain_error = 0.06,
                                .noise_floor_rad_s = 0.06 * degree,
                                .usual_range_rad_s = 2000 * degree};

constexpr ClassFigures industrial{.bias_after_rest_rad_s = 0.03 * degree,
                                  .bias_unknown_rad_s = 0.3 * degree,
                                  .bias_calibrated_rad_s = 0.1 * degree,
                                  .gain = 0.005,
                                  .gain_calibrated = 0.001,
                                  .bias_floor_rad_s = 0.03 * degree,
                                  .gain_floor = 4e-4,
                                  .bias_wander_rad_s_root_s = 0.001 * degree,
                                  .largest_bias_rad_s = 2 * degree,
                                  .largest_drift_rad_s = 0.75 * degree,
                                  .largest_gain_error = 0.025,
                                  .noise_floor_rad_s = 0.02 * degree,
                                  .usual_range_rad_s = 2000 * degree};

constexpr ClassFigures tactical{.bias_after_rest_rad_s = 10 * degree_per_hour,
                                .bias_unknown_rad_s = 60 * degree_per_hour,
                                .bias_calibrated_rad_s = 20 * degree_per_hour,
                                .gain = 0.0015,
                                .gain_calibrated = 3e-4,
                                .bias_floor_rad_s = 10 * degree_per_hour,
                                .gain_floor = 2e-4,
                                .bias_wander_rad_s_root_s = 0.3 * degree_per_hour,
                                .largest_bias_rad_s = 500 * degree_per_hour,
                                .largest_drift_rad_s = 200 * degree_per_hour,
                                .largest_gain_error = 0.01,
                                .noise_floor_rad_s = 20 * degree_per_hour,
                                .usual_range_rad_s = 400 * degree};

constexpr ClassFigures fibre_optic{.bias_after_rest_rad_s = 1 * degree_per_hour,
                                   .bias_unknown_rad_s = 5 * degree_per_hour,
                                   .bias_calibrated_rad_s = 2 * degree_per_hour,
                                   .gain = 0.001,
                                   .gain_calibrated = 1e-4,
                                   .bias_floor_rad_s = 1 * degree_per_hour,
                                   .gain_floor = 5e-5,
                                   .bias_wander_rad_s_root_s = 0.03 * degree_per_hour,
                                   .largest_bias_rad_s = 40 * degree_per_hour,
                                   .largest_drift_rad_s = 20 * degree_per_hour,
                                   .largest_gain_error = 0.005,
                                   .noise_floor_rad_s = 2 * degree_per_hour,
                                   .usual_range_rad_s = 490 * degree};

constexpr std::array class_names{std::pair{SensorClass::consumer, std::string_view("consumer")},
                                 std::pair{SensorClass::industrial, std::string_view("industrial")},
                                 std::pair{SensorClass::tactical, std::string_view("tactical")},
                                 std::pair{SensorClass::fibre_optic, std::string_view("fibre-optic")}};

constexpr std::array mount_names{std::pair{Mount::board, std::string_view("board")},
                                 std::pair{Mount::structure, std::string_view("structure")}};

template <class Value, std::size_t Size>
std::optional<Value> value_named(const std::array<std::pair<Value, std::string_view>, Size>& names, std::string_view name)
{
    for (const auto& [value, known] : names)
        if (known == name) return value;
    return std::nullopt;
}

template <class Value, std::size_t Size>
std::vector<std::string_view> words_of(const std::array<std::pair<Value, std::string_view>, Size>& names)
{
    std::vector<std::string_view> words;
    for (const auto& entry : names) words.push_back(entry.second);
    return words;
}

}  // namespace

const ClassFigures& figures_of(SensorClass sensor_class)
{
    switch (sensor_class) {
        case SensorClass::industrial: return industrial;
        case SensorClass::tactical: return tactical;
        case SensorClass::fibre_optic: return fibre_optic;
        case SensorClass::consumer: break;
    }
    return consumer;
}

std::string_view name_of(SensorClass sensor_class)
{
    return class_names[static_cast<std::size_t>(sensor_class)].second;
}

std::optional<SensorClass> sensor_class_named(std::string_view name)
{
    return value_named(class_names, name);
}

std::string_view name_of(Mount mount)
{
    return mount_names[static_cast<std::size_t>(mount)].second;
}

std::optional<Mount> mount_named(std::string_view name)
{
    return value_named(mount_names, name);
}

std::vector<std::string_view> names_of(SensorClass)
{
    return words_of(class_names);
}

std::vector<std::string_view> names_of(Mount)
{
    return words_of(mount_names);
}

}  // namespace quorient::fdi
