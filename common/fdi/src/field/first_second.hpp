#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace quorient::fdi::field {

/// What one axis reads in the first second after it was switched on, and when that is a rest.
class FirstSecond {
public:
    static constexpr double largest_deviation_at_rest = 0.5 * std::numbers::pi / 180;  ///< rad/s, of every axis
    static constexpr double largest_rate_at_rest = 6 * std::numbers::pi / 180;         ///< rad/s, of the median sensor
    static constexpr double recent_s = 0.5;  ///< memory of what started sensors read

    static std::size_t frames_needed(double interval_s) { return static_cast<std::size_t>(std::lround(1.0 / interval_s)); }

    void add(double rate)
    {
        sum_ += rate;
        squares_ += rate * rate;
        ++frames_;
    }

    std::size_t frames() const { return frames_; }
    double mean() const { return sum_ / static_cast<double>(frames_); }
    double deviation() const { return std::sqrt(std::max(0.0, squares_ / static_cast<double>(frames_) - mean() * mean())); }

private:
    std::size_t frames_ = 0;
    double sum_ = 0;
    double squares_ = 0;
};

}  // namespace quorient::fdi::field
