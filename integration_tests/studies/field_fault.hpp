#pragma once

#include "field_log.hpp"
#include "quorient/messages/codes.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <string_view>

namespace quorient::studies {

/// How a fault spoils what an instrument measures.
enum class Spoil : std::uint8_t {
    bias,        ///< size [rad/s], of random sign
    gain,        ///< size = factor
    sign,
    stuck,       ///< the value of the onset repeats
    delay,       ///< all axes one sample late
    noise,       ///< white, size = times what the log shows
    ramp,        ///< size [rad/s^2], of random sign
    dropout,     ///< no data of all axes
    full_scale,  ///< one sample in 200 reads -2000 deg/s
    half_rate,   ///< every second measurement of all axes repeats the one before
    mounting,    ///< turned by 90 degrees about its third axis
    alternating, ///< size [rad/s] for 0.3 s of every second
};

struct FieldFault {
    std::string_view name;
    Spoil spoil;
    double size = 0;
    double lasts_s = std::numeric_limits<double>::infinity();
    bool passes = false;   ///< right is to latch nobody
    bool turning = false;  ///< shows only while the body turns: begins where it does
    bool whole = false;    ///< spoils all axes of the instrument
    Diagnosis kind = Diagnosis::none;
};

/// The faults of the study's tables.
std::span<const FieldFault> field_faults();

/// One fault in one place of a log.
struct Injection {
    FieldFault fault;
    std::size_t instrument = 0;
    std::size_t axis = 0;  ///< place in the log
    std::size_t onset = 0; ///< frame
    double sign = 1;
    double noise_rad_s = 0;  ///< one sample in this log
};

/// Instrument, axis, sign and onset at random, the onset between 2 s after the log's begin and 85 % of its length. Faults that only rotation shows
/// begin where the body turns by more than 10 deg/s in each of the next four half seconds, as far as the log has such a place.
Injection draw(const FieldLog& log, const FieldFault& fault, double noise_rad_s, std::mt19937_64& random);

/// What differs between two instruments from sample to sample: standard deviation of one sample, at least 0.06 deg/s [rad/s].
double sample_noise(const FieldLog& log);

/// Spoils the frames of a log, in order.
class Spoiler {
public:
    Spoiler(const FieldLog& log, const Injection& injection, std::uint64_t seed);

    /// @param place  of the frame in the log
    void apply(std::size_t place, SensorFrame& frame);

private:
    bool active(std::size_t place) const;
    void spoil(std::size_t place, SensorFrame& frame);

    const FieldLog& log_;
    Injection injection_;
    std::array<std::size_t, 3> axes_{};
    std::mt19937_64 random_;
    double begin_s_;
};

}  // namespace quorient::studies
