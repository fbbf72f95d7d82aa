#pragma once

#include "quorient/fdi/sensor_class.hpp"
#include "quorient/settings/setting.hpp"

#include <array>
#include <optional>
#include <string>

namespace quorient::fdi {

/// How wrong the axes of a real array are beyond their noise at rest. Each term is one standard deviation.
struct MotionNoise {
    double jitter_along_s = 0;    ///< times |d omega/dt|: each instrument's sampling instants wander; along d omega/dt …
    double jitter_across_s = 0;   ///< … and across it; both independent between frames and between instruments
    double roughness_s = 0;       ///< times the lately largest |d omega/dt|: outliers, which a few frames of a window dominate
    double axes_error = 0;        ///< times the rotation: misalignment and scale that calibration left; what turns back is taken back
    double rate_error = 0;        ///< times the angle turned through, whichever way: errors of another law (asymmetry, rate squared)
    double bias_floor_rad_s = 0;  ///< constant error of each axis that calibration left
};

/// Everything a user can set about detection; what is absent takes the method's default. What each means stands in detector_record().
/// Tolerances are in the unit of the measurement (rad of one increment for gyros).
struct DetectorSettings {
    std::string method = "auto";  ///< one of methods(), see make_detector
    std::optional<double> tolerance{};
    std::optional<double> sigma{};
    std::optional<double> pfa{};
    std::optional<double> bound{};
    std::optional<double> threshold{};
    std::optional<std::array<double, 3>> direction{};  ///< guaranteed: also the interval along this body vector
    std::optional<unsigned> max_faults{};
    std::optional<double> margin{};
    std::optional<double> doubt{};
    std::optional<double> motion_noise{};
    std::optional<MotionNoise> gated_noise{};  ///< accumulating: of the gated sums, without outliers and bias floor; absent: there are none
    SensorClass sensor_class = SensorClass::consumer;
    Mount mount = Mount::board;
    std::optional<double> delay_class_s{};
    bool calibrated = false;  ///< field: biases and gains are those of a calibration in another run
    bool instruments = false;
    bool relaxed = false;
    bool bare = false;
};

/// All but the words: method, sensor class and mount.
settings::Record<DetectorSettings> detector_record();

/// From assessments to verdicts: what each means stands in verdict_record().
struct VerdictSettings {
    unsigned confirm_required = 2;
    unsigned confirm_window = 3;
    unsigned warm_up_frames = 10;
    unsigned onset_guard_frames = 1;
    std::optional<double> readmit_after_s{};
};

settings::Record<VerdictSettings> verdict_record();

/// What of them cannot be together. @returns the key and why.
tl::expected<void, std::string> check(const VerdictSettings& settings);

}  // namespace quorient::fdi
