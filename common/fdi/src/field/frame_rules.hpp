#pragma once

#include <cmath>

namespace quorient::fdi::field {

/// Residuals are coloured: so many frames are one independent piece of information.
inline constexpr double usual_colour = 10;

/// A frame in which a sensor deviates by more is off.
inline constexpr double off_sigmas = 6;

/// Variance of a difference to the mean of two, in units of one.
inline constexpr double pair = 1.5;

/// The variance that wandering sampling instants make of the motion, by 0.8 % of the interval along the change of rate, across it by a part of that.
/// @param along, all  squares of the change of rate in one interval, along the sensor's direction and in all directions
inline double wander_variance(double along, double all)
{
    constexpr double jitter_intervals = 0.008;
    constexpr double jitter_across = 0.3;
    return jitter_intervals * jitter_intervals * (along + jitter_across * (all - along));
}

/// What a frame counts: less where the motion makes differences uncertain beyond some times the least noise.
inline double frame_weight(double wander_variance, double least_noise)
{
    constexpr double noises = 3;
    const double calm = noises * noises * least_noise * least_noise;
    return calm / (calm + wander_variance);
}

/// The largest deviation that a frame counts with where what lasts is looked for: 1.5 times the limit of a lasting contradiction, and noise.
inline double clip_limit(double allowance, double noise_variance)
{
    constexpr double allowances = 9;
    constexpr double noises = 4;
    return allowances * std::sqrt(pair * allowance) + noises * std::sqrt(pair * noise_variance);
}

}  // namespace quorient::fdi::field
