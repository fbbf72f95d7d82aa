#pragma once

#include "field_attitude.hpp"
#include "field_fault.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/messages/fault_diagnosis.hpp"

#include <limits>
#include <optional>
#include <string>

namespace quorient::studies {

/// What a detector did on a log as it is.
struct SoundRun {
    AxisMask latched = 0;
    double first_latched_s = 0;      ///< since the log's begin
    unsigned provisional_times = 0;  ///< instruments that were left out, each time
    double provisional_s = 0;
    double saturated_s = 0;
    double degraded_s = 0;
    FaultDiagnosis diagnosis;  ///< at the end
    AxisMask px4 = 0;
    double px4_s = 0;
};
SoundRun play_sound(const FieldLog& log, fdi::FaultMonitor monitor);

/// What it did with one fault. Times from the onset.
struct FaultRun {
    static constexpr double never_s = std::numeric_limits<double>::infinity();

    double protected_s = never_s;  ///< the attitude no longer follows the instrument
    double latched_s = never_s;
    AxisMask wrong = 0;            ///< latched axes of other instruments, and any that were latched before the onset
    double wrong_s = never_s;      ///< when, from the onset on
    std::string injected;          ///< where and when, for what went wrong
    FaultDiagnosis diagnosis;      ///< at the end
    bool named_axis = false;       ///< by the diagnosis at the end, and no other of this instrument
    bool named_kind = false;
    std::optional<double> size_error{};  ///< in the unit of the diagnosis, where it named the kind
    AttitudeError attitude{};            ///< beside one that was made without the fault

    /// PX4's rule: the faulty gyro named, or else wrong; the attitude where the vehicle flies by that gyro until then.
    struct Px4 {
        double named_s = never_s;
        bool wrong = false;
        AttitudeError attitude;
    };
    Px4 px4{};

    /// ArduPilot's: before arming; the attitude where the vehicle flies by the faulty gyro.
    struct ArduPilot {
        bool refuses = false;
        AttitudeError attitude;
    };
    ArduPilot ardupilot{};
};
FaultRun play_fault(const FieldLog& log, const Injection& injection, std::uint64_t seed, fdi::FaultMonitor monitor);

}  // namespace quorient::studies
