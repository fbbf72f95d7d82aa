#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace quorient::simulation {

/// Random numbers as pure functions of (seed, stream, counter): a skipped frame changes no later value. The mixer is SplitMix64's
/// finaliser [Steele, Lea & Flood 2014].
constexpr std::uint64_t mixed(std::uint64_t value)
{
    value += 0x9E3779B97F4A7C15U;
    value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
    value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
    return value ^ (value >> 31U);
}

constexpr std::uint64_t mixed(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter)
{
    return mixed(mixed(mixed(seed) ^ stream) ^ counter);
}

/// In (0, 1): the middle of one of 2^53 equal cells.
constexpr double uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter)
{
    return (static_cast<double>(mixed(seed, stream, counter) >> 11U) + 0.5) * 0x1p-53;
}

/// Standard normal, by Box and Muller.
inline double gaussian(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter)
{
    const double radius = std::sqrt(-2.0 * std::log(uniform(seed, 2 * stream, counter)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(seed, 2 * stream + 1, counter));
}

}  // namespace quorient::simulation
