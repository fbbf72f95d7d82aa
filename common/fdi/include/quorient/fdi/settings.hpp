#pragma once

#include <array>
#include <optional>
#include <string>

namespace quorient::fdi {

/// What a moving array shows beyond its noise at rest in all but its worst frames: the terms of MotionNoise of the same names.
struct GatedNoise {
    double jitter_along_s = 0;
    double jitter_across_s = 0;
    double axes_error = 0;
    double rate_error = 0;
};

/// Everything a user can set about detection; what is absent takes the method's default.
/// Lengths of time in seconds, tolerances in the unit of the measurement (rad of one increment for gyros).
struct DetectorSettings {
    std::string method = "auto";  ///< auto: by the cluster, see make_detector
    std::optional<double> tolerance{};
    std::optional<double> sigma{};  ///< in place of the description's
    std::optional<double> pfa{};    ///< false-alarm probability of one frame
    std::optional<double> bound{};
    std::optional<double> threshold{};
    std::optional<std::array<double, 3>> direction{};  ///< guaranteed: also the interval along this body vector
    std::optional<unsigned> max_faults{};
    std::optional<double> margin{};
    std::optional<double> doubt{};         ///< subset: share of right isolations held back because one more, small fault is not ruled out
    std::optional<double> motion_noise{};  ///< accumulating: times the usual errors of a moving array, see usual_motion_noise
    std::optional<GatedNoise> gated_noise{};  ///< accumulating: of the gated sums; absent: there are none
    bool instruments = false;                 ///< a fault takes a whole instrument
    bool relaxed = false;
    bool bare = false;  ///< mean, relaxed invariants: the paper's rule as such, which does not look for rivals
};

/// From assessments to verdicts.
struct VerdictSettings {
    unsigned confirm_required = 2;  ///< m …
    unsigned confirm_window = 3;    ///< … of n frames
    unsigned warm_up_frames = 10;
    unsigned onset_guard_frames = 1;          ///< placed early: one frame late costs a contaminated increment, early costs nothing
    std::optional<double> readmit_after_s{};  ///< absent: by command only
};

}  // namespace quorient::fdi
