#pragma once

#include "quorient/evaluation/run_observer.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace quorient::report {

/// The smallest and the largest value of a time, so that a spike of one frame stays visible.
struct Extent {
    double least = std::numeric_limits<double>::infinity();
    double largest = -std::numeric_limits<double>::infinity();

    bool empty() const { return !(least <= largest); }

    /// A value that is not a number is left out.
    void add(double value)
    {
        if (value < least) least = value;
        if (value > largest) largest = value;
    }
    void add(const Extent& other)
    {
        if (other.empty()) return;
        add(other.least);
        add(other.largest);
    }
};

/// What happened in one piece of a run's time.
struct RunMoment {
    struct Lane {
        Extent statistic;                        ///< in units of its threshold
        std::array<Extent, max_axes> residual;   ///< its magnitude in units of its bound
        AxisMask isolated = 0;                   ///< at any moment of this piece; likewise below
        AxisMask provisional = 0;
    };

    Extent error_rad;             ///< the voted attitude's, against the truth
    Extent without_rollback_rad;  ///< as RunObserver::without_rollback()
    std::array<Extent, 3> roll_pitch_yaw_deg;  ///< the voted attitude's; runs on beyond 180
    std::array<Lane, max_lanes> lane{};
    AxisMask faulty = 0;                  ///< by the truth
    VoteLevel level = VoteLevel::unknown; ///< the gravest

    void add(const RunMoment& later);
};

/// A run in at most `most_moments` pieces of equal length: where the run is longer, the pieces become longer. Memory is bounded.
/// Times are the samples' own. A new epoch of the sensor whose times begin again follows behind the one before.
class RunTimeline {
public:
    static constexpr std::size_t most_moments = 320;

    /// @param observer  its errors are shown; it has to live as long as this, and to be given the same messages
    RunTimeline(const system::System& system, evaluation::RunObserver& observer);

    void on_truth(const TruthState& truth);
    void on_verdict(const FaultVerdict& verdict);
    void on_voted(const VotedAttitude& voted);

    double begin_s() const { return begin_s_; }
    double moment_s() const { return moment_s_; }
    const std::vector<RunMoment>& moments() const { return moments_; }

private:
    RunMoment* moment_at(std::uint64_t epoch, std::int64_t sample_time_ns);
    double time_s(std::uint64_t epoch, std::int64_t sample_time_ns);
    void shorten();

    const system::System& system_;
    std::uint64_t epoch_ = 0;
    double shift_s_ = 0;  ///< the newest epoch's
    double newest_s_ = 0;
    double begin_s_ = 0;
    double moment_s_;
    std::vector<RunMoment> moments_;
    Identity newest_voted_;
    std::array<double, 3> latest_angle_deg_{};
};

}  // namespace quorient::report
