#pragma once

#include <cmath>
#include <cstdint>

namespace quorient::recording {

/// A log's time line: judges each record's step against the nominal interval and keeps a time that only moves forward.
class LogClock {
public:
    enum class Step { regular, gap, repeated, irregular };

    explicit LogClock(std::int64_t nominal_ns = 0) : nominal_ns_(nominal_ns) {}

    /// @param step_ns  from the record before to this one, by the log's own clock.
    Step advance(std::int64_t step_ns)
    {
        const std::int64_t intervals = std::llround(static_cast<double>(step_ns) / static_cast<double>(nominal_ns_));
        const bool fits = intervals >= 1 &&
                          std::abs(static_cast<double>(step_ns - intervals * nominal_ns_)) <= tolerance * static_cast<double>(nominal_ns_);
        // After a jump that no gap explains the clock's step is meaningless: one interval is the best guess.
        const bool jumped = step_ns < 0 || step_ns > longest_gap_ns;
        elapsed_ns_ += jumped ? nominal_ns_ : step_ns;
        missing_ = fits && !jumped ? static_cast<std::uint64_t>(intervals - 1) : 0;
        if (step_ns == 0) return Step::repeated;
        if (!fits || jumped) return Step::irregular;
        return missing_ == 0 ? Step::regular : Step::gap;
    }

    /// Records missing before the latest one.
    std::uint64_t missing() const { return missing_; }

    std::int64_t elapsed_ns() const { return elapsed_ns_; }  ///< from the first record to the latest
    std::int64_t nominal_ns() const { return nominal_ns_; }

    /// How many intervals lie between two times of this clock.
    std::uint64_t intervals(std::int64_t span_ns) const
    {
        return static_cast<std::uint64_t>(std::llround(static_cast<double>(span_ns) / static_cast<double>(nominal_ns_)));
    }

private:
    static constexpr double tolerance = 0.25;                       // in intervals; the recordings at hand jitter by 2 %
    static constexpr std::int64_t longest_gap_ns = 60'000'000'000;  // beyond it a step forward is a clock set anew

    std::int64_t nominal_ns_;
    std::int64_t elapsed_ns_ = 0;
    std::uint64_t missing_ = 0;
};

}  // namespace quorient::recording
