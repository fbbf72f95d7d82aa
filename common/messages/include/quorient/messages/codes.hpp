#pragma once

#include <cstdint>

namespace quorient {

// States travel as octets: an enum in the IDL would make Fast DDS's zero-copy paths fail. 0 is always "unknown".

enum class SensorKind : std::uint8_t { unknown = 0, gyro = 1, accelerometer = 2, vessel_rates = 3 };

/// What a detector says of its cluster (the state machine is drawn in common/fdi/README.md).
enum class VerdictState : std::uint8_t {
    unknown = 0,
    warming_up = 1,
    healthy = 2,
    suspect = 3,    // a fault is seen and not yet confirmed
    isolated = 4,   // the faulty axes are named
    ambiguous = 5,  // a fault, and the sets that explain it
    blind = 6,      // more faults than the data can show
    provisional = 7,  // an axis is left out until the contradiction ends or is confirmed
    saturated = 8,    // all instruments are at their range: nobody is to blame, and the attitude is not trustworthy from here on
};

/// What is wrong with an axis that a detector left out, isolated, or reports as degraded.
enum class Diagnosis : std::uint8_t {
    none = 0,
    bias = 1,           // rad/s too much
    gain = 2,           // reads this share of the true rate
    sign = 3,           // reads the true rate with the wrong sign
    delay = 4,          // s late
    stuck = 5,          // repeats one value while it should move
    zero = 6,           // stuck at exactly 0
    saturated = 7,      // at its range while the others are not
    noise = 8,          // times its usual noise
    spikes = 9,         // single samples, rad/s
    mounting = 10,      // turned against the others by this angle, rad
    outside_class = 11, // beyond what its class of sensors allows, rad/s
    erratic = 12,       // comes and goes
    absent = 13,        // sends no data
};

/// How far an attitude can be trusted.
enum class AttitudeMode : std::uint8_t {
    unknown = 0,
    initialising = 1,  // no voter counts it
    normal = 2,
    ambiguous = 3,  // the last trusted axes are in use although one of them may be faulty
    untrusted = 4,  // the detector is blind
    coasting = 5,   // no increment is applied: the attitude is held and its standard deviation grows
    lost = 6,       // the rotation since the last good frame is not known
    truth = 7,      // the simulator's own
};

/// How many lanes stand behind a voted attitude.
enum class VoteLevel : std::uint8_t { unknown = 0, full = 1, degraded = 2, single = 3, coasting = 4, lost = 5 };

/// Why a voter leaves a lane out.
enum class LaneExclusion : std::uint8_t {
    none = 0,
    silent = 1,
    initialising = 2,
    disagrees = 3,
    uncorroborated = 4,  // isolated axes that no majority of detectors reports
    outvoted = 5,        // keeps axes that a corroborated group has isolated
    untrusted = 6,
    invalid = 7,  // not finite, or not a unit quaternion
};

enum class Severity : std::uint8_t { unknown = 0, info = 1, warning_low = 2, warning_high = 3, fatal = 4 };

enum class EventCode : std::uint8_t {
    unknown = 0,
    started = 1,
    ready = 2,
    goodbye = 3,
    suspect = 10,
    isolated = 11,
    ambiguous = 12,
    blind = 13,
    readmitted = 14,
    redundancy_exhausted = 15,
    adopted = 16,
    left_out = 17,   // provisionally
    returned = 18,   // an axis that was left out
    saturated = 19,
    rolled_back = 20,
    history_too_short = 21,
    coasting = 22,
    lost = 23,
    seeded = 24,
    absent = 25,     // an axis sends no data
    present = 26,    // and sends again
    degraded = 27,   // noisy or late, still in use
    primary_changed = 30,
    lane_excluded = 31,
    lane_returned = 32,
    level_changed = 33,
    ownership_taken = 34,
    foreign_publisher = 40,
    new_epoch = 41,
    rejected_input = 42,
    gap_bridged = 43,
    no_match = 44,
    incompatible_qos = 45,
    transport_fallback = 46,
    shared_memory_lost = 47,
    fault_injected = 50,
    fault_cleared = 51,
    command_done = 52,
    command_refused = 53,
    unknown_revision = 54,
    consumers_missing = 55,
    other_contract = 56,  // a peer has another version of the wire contract
    security = 57,        // a peer or a sample was refused
    overloaded = 58,      // frames are skipped, since this machine cannot carry the rate
    identity_expires = 60,  // in less than 30 days
};

enum class ServiceState : std::uint8_t { unknown = 0, starting = 1, ready = 2, running = 3, stopping = 4 };

enum class ServiceRole : std::uint8_t { unknown = 0, sensor = 1, detector = 2, integrator = 3, voter = 4, monitor = 5 };

enum class Vendor : std::uint8_t { unknown = 0, local = 1, fastdds = 2, cyclonedds = 3 };

/// The path that samples really take.
enum class Transport : std::uint8_t { unknown = 0, in_process = 1, udp = 2, shared_memory = 3, iceoryx = 4 };

/// What a description says of the attitude at the start of its sequence 0.
enum class InitialAttitude : std::uint8_t {
    unknown = 0,
    stated = 1,    ///< by configuration: true when the system starts, not when its publisher starts again
    measured = 2,  ///< at the start of this very epoch
};

enum class CommandAction : std::uint8_t {
    unknown = 0,
    inject = 1,
    clear = 2,
    readmit = 3,
    reset_attitude = 4,
};

enum class FaultKind : std::uint8_t {
    unknown = 0,
    bias = 1,   // rad/s
    ramp = 2,   // rad/s^2
    scale = 3,  // factor
    stuck = 4,  // the last value repeats
    zero = 5,
    rail = 6,  // the axis's range
    sign = 7,
    nan = 8,
    noise = 9,         // multiple of the axis's sigma
    oscillation = 10,  // rad/s, with frequency_hz
    dropout = 11,      // fraction of frames without a sample
    delay = 12,        // seconds
    spike = 13,        // rad/s, with period_s
};

}  // namespace quorient
