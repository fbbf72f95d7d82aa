#pragma once

#include "axis_state.hpp"
#include "tick.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

namespace quorient::monitor {

/// What the plots show of a time: a tick, or the ticks of one second. Minimum and maximum are kept.
struct Sample {
    struct Lane {
        std::array<Range, max_axes> residual{};
        std::array<double, max_axes> bound{};  ///< the newest
    };

    std::int64_t wall_time_ns = 0;  ///< the newest tick's
    std::size_t lanes = 0;
    std::size_t axes = 0;
    double sigma_rad = not_known;
    Range error;
    std::array<Lane, max_lanes> lane{};
    std::array<AxisState, max_axes> axis{};  ///< the gravest

    /// Takes in a later sample of the same lanes and axes.
    void add(const Sample& later);
};

Sample sample_of(const Tick& tick, std::size_t lanes);

/// The last ten minutes, a sample per second, as text. The writer is one thread, readers are many.
class History {
public:
    static constexpr std::size_t longest_s = 600;

    void add(const Sample& sample);

    /// All of it as a JSON array, oldest first.
    std::string text() const;

private:
    Sample second_;
    mutable std::mutex mutex_;
    std::deque<std::string> seconds_;
};

}  // namespace quorient::monitor
