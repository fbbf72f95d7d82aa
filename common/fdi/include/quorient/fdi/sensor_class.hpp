#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace quorient::fdi {

/// How good the instruments of an array are: what sound ones may differ by.
enum class SensorClass : std::uint8_t { consumer, industrial, tactical, fibre_optic };

/// Whether all instruments see the same motion.
enum class Mount : std::uint8_t {
    board,      ///< on one board or rigid block
    structure,  ///< separate boxes on a frame that flexes: they see different vibration, and none is faulty
};

/// What is known of a class: standard deviations between sound instruments, unless said otherwise. Sources: common/fdi/README.md.
struct ClassFigures {
    double bias_after_rest_rad_s;        ///< once the mean of a resting second is taken out
    double bias_unknown_rad_s;           ///< before anything is known
    double bias_calibrated_rad_s;        ///< calibrated in another run
    double gain;                         ///< scale and cross-axis
    double gain_calibrated;
    double bias_floor_rad_s;             ///< what may change without being learned
    double gain_floor;                   ///< likewise
    double bias_wander_rad_s_root_s;     ///< random walk of the bias, after one second
    double largest_bias_rad_s;           ///< beyond it: outside the class
    double largest_drift_rad_s;          ///< the bias since a resting start drifts no further; beyond it: outside the class
    double largest_gain_error;           ///< beyond it: outside the class
    double noise_floor_rad_s;            ///< the least that one frame's noise is taken for
    double usual_range_rad_s;            ///< for an instrument that states none
};

const ClassFigures& figures_of(SensorClass sensor_class);

std::string_view name_of(SensorClass sensor_class);
std::optional<SensorClass> sensor_class_named(std::string_view name);
std::string_view name_of(Mount mount);
std::optional<Mount> mount_named(std::string_view name);

/// All words of the value's type, in its order.
std::vector<std::string_view> names_of(SensorClass);
std::vector<std::string_view> names_of(Mount);

}  // namespace quorient::fdi
