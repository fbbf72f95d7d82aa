#pragma once

#include "quorient/recording/end_of_range.hpp"
#include "quorient/recording/instrument_log.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace quorient::recording {

/// How regularly one instrument's samples stand in a log, and what their values show without any other instrument.
struct InstrumentFigures {
    std::uint64_t samples = 0;
    double period_s = 0;      ///< usual time between two samples; 0 = fewer than three samples with times one after the other
    double jitter_s = 0;      ///< standard deviation of the regular steps about the period
    std::uint64_t gaps = 0;   ///< steps of more than 1.5 periods
    double longest_gap_s = 0;
    std::uint64_t lost = 0;         ///< samples missing in gaps: whole periods
    std::uint64_t duplicates = 0;   ///< samples with the stamp of the one before
    std::uint64_t steps_back = 0;   ///< stamps before the one before
    std::int64_t first_ns = 0;
    std::int64_t last_ns = 0;
    double coverage = 0;            ///< share of the time from first to last, without holes of 10 s or more, that samples stand for
    std::array<std::uint64_t, 3> repeated{};       ///< samples with the value of the one before, by axis
    std::array<double, 3> longest_repeat_s{};      ///< the longest time that an axis kept one value
    std::array<std::uint64_t, 3> clipped{};        ///< samples that the log itself calls clipped
    bool clipping_logged = false;
    std::array<std::uint64_t, 3> at_extreme{};     ///< samples at the largest magnitude of the axis, if that came again and again
    std::array<double, 3> largest_rad_s{};
    std::array<std::optional<Clipping>, 3> range_reached{};  ///< by axis, judged by the values; nothing: they look like motion
    std::uint64_t beyond_gyros = 0;                ///< samples with a rate that no gyro reads: 4500 deg/s and more
    std::uint64_t not_finite = 0;                  ///< samples without a value on one axis at least
    double temperature_min_c = not_logged;
    double temperature_max_c = not_logged;

    /// Not a spike now and then: the unit of the rates is wrong.
    bool is_beyond_gyros() const { return 100 * beyond_gyros > samples; }

    double rate_hz() const { return period_s > 0 ? 1.0 / period_s : 0.0; }
    double duration_s() const { return static_cast<double>(last_ns - first_ns) * 1e-9; }
};

/// A time in which an instrument's rate of sampling differed from its usual one for 2 s or more.
struct RateChange {
    double from_s = 0;  ///< since the instrument's first sample
    double rate_hz = 0;
};

/// Collects the figures of one instrument, sample by sample. Holds a fixed buffer.
class InstrumentMeter {
public:
    void add(const InstrumentSample& sample);

    /// @returns what was seen so far
    InstrumentFigures figures() const;
    std::vector<RateChange> rate_changes() const;

private:
    /// A step so far ahead that it may lead to another epoch, and the figures before it.
    struct Jump {
        std::int64_t from_ns = 0;
        std::uint64_t gaps = 0;
        std::uint64_t lost = 0;
        double longest_gap_s = 0;
        double holes_s = 0;
    };

    void judge_stamp(const InstrumentSample& sample);
    void return_to_line(std::int64_t time_ns);
    void judge_step(std::int64_t step_ns, double covered_s);
    void judge_values(const InstrumentSample& sample);
    void count_for_rate(std::int64_t time_ns);
    void learn_period();

    InstrumentFigures figures_;
    std::vector<std::int64_t> first_steps_ns_;  // until the period is known
    std::vector<double> first_covered_s_;       // what the samples behind these steps covered
    std::optional<InstrumentSample> before_;
    std::optional<Jump> jump_;
    std::array<EndOfRange, 3> upper_ends_;
    std::array<EndOfRange, 3> lower_ends_;
    std::array<std::int64_t, 3> kept_since_ns_{};  // since when each axis has had its value
    double covered_s_ = 0;
    double holes_s_ = 0;
    double regular_steps_ = 0;
    double regular_sum_s_ = 0;
    double regular_squares_ = 0;
    std::int64_t stretch_begin_ns_ = 0;   // stretch over which the rate is counted
    std::uint64_t stretch_samples_ = 0;
    std::vector<RateChange> stretches_;   // rate of each stretch that differs from the one before
};

}  // namespace quorient::recording
