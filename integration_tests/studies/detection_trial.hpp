#pragma once

#include "quorient/evaluation/fault_spells.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/simulation/faults.hpp"
#include "recorded_array.hpp"

#include <cstdint>
#include <limits>
#include <numbers>

namespace quorient::studies {

enum class Judgement : std::uint8_t {
    right,      ///< what was isolated first holds the faulty axis, and none beyond what the setting allows
    wrong,      ///< anything else was isolated, or something before the fault began
    ambiguous,  ///< a fault was seen, with candidates, and not isolated within the horizon
    missed,
};

/// What one method made of a fault; times from the fault's beginning to the end of the frame, infinite where it did not come to that.
struct Judged {
    Judgement judgement = Judgement::missed;
    evaluation::Reaction reaction;

    double detected_s() const { return reaction.detected_s.value_or(std::numeric_limits<double>::infinity()); }
    double isolated_s() const { return reaction.isolated_s.value_or(std::numeric_limits<double>::infinity()); }
};

/// One fault on one axis of a recording.
struct Trial {
    simulation::FaultSpec fault;  ///< begins with frame `onset`
    std::size_t onset = 0;
    std::size_t axis = 0;
    AxisMask allowed = 0;  ///< what may be isolated with the axis: itself, or its instrument
};

struct TrialResult {
    Judged ours;
    Judged px4;
    /// Where ours is right and the fault is a bias:
    double onset_error_s = 0;       ///< excluded from, minus true onset; below 0 = early
    double attitude_error_rad = 0;  ///< after roll-back, against a run that knew the true onset
    double attitude_bound_rad = 0;  ///< 0.1 deg + weight x fault x onset error
};

inline constexpr double horizon_s = 24;

/// What the attitude's bound allows for whatever the onset's error.
inline constexpr double free_of_charge_rad = 0.1 * std::numbers::pi / 180;

/// Frames that a detector sees before the fault begins: more than its longest window.
inline constexpr std::size_t frames_before_fault = 600;

/// Plays the trial through the monitor and, beside it, the PX4 rule (three instruments or more).
TrialResult play(const RecordedArray& array, const Trial& trial, fdi::FaultMonitor monitor);

}  // namespace quorient::studies
