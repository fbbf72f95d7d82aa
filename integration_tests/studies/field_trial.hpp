#pragma once

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
    double attitude_error_rad = 0;       ///< at the end, beside an attitude that was made without the fault
    double px4_s = never_s;
    bool px4_wrong = false;
};
FaultRun play_fault(const FieldLog& log, const Injection& injection, std::uint64_t seed, fdi::FaultMonitor monitor);

}  // namespace quorient::studies
