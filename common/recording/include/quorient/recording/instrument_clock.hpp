#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace quorient::recording {

/// The period of a free-running instrument from stamps that a host gave on arrival: never early, often late, some samples lost.
/// In stretches of samples the earliest arrival, relative to a regular clock, lies on the instrument's own clock but for whole periods.
class PeriodEstimator {
public:
    explicit PeriodEstimator(double first_guess_s) : guess_s_(first_guess_s) {}

    void add(std::int64_t stamp_ns);

    /// @returns nothing before some stretches were seen
    std::optional<double> period_s() const;

private:
    struct Earliest {
        double number = 0;  // the sample's
        double late_s = 0;  // its stamp against number x guess, from the first stamp on
    };

    double guess_s_;
    std::optional<std::int64_t> first_ns_;
    double number_ = 0;
    double in_stretch_ = 0;
    Earliest earliest_;
    std::vector<Earliest> stretches_;
};

/// Where a stamp of arrival belongs on the instrument's own clock.
struct Placement {
    std::int64_t time_ns = 0;
    double late_s = 0;       ///< lateness of the stamp, at least minus half a period
    std::uint64_t lost = 0;  ///< whole samples missing before this one
    bool restarted = false;  ///< the clock stepped: nothing ties this sample to the one before
};

/// Places samples on their instrument's own clock: sample number times period, plus whole lost samples. A lost sample shows only later, when
/// no stamp arrives as early as it should. So the clock looks 20 s ahead before it places a sample. An error of 1e-4 in the period costs 2 ms.
class ArrivalClock {
public:
    explicit ArrivalClock(double period_s) : period_s_(period_s) {}

    void add(std::int64_t stamp_ns);

    /// No more stamps: what waits can be placed.
    void finish() { finished_ = true; }

    /// The next sample in the order of arrival, if enough is known.
    std::optional<Placement> next();

private:
    struct Waiting {
        std::uint64_t number = 0;
        std::int64_t stamp_ns = 0;
        double late_s = 0;  // stamp against number x period since the origin
    };

    Placement place(const Waiting& waiting, double earliest_s);

    double period_s_;
    std::uint64_t number_ = 0;
    std::int64_t origin_ns_ = 0;
    std::optional<std::int64_t> last_ns_;
    std::deque<Waiting> waiting_;
    std::deque<Waiting> minima_;  // candidates for the earliest of those waiting, rising
    std::optional<double> base_s_;  // lateness of the instrument's own clock against number x period
    std::vector<std::uint64_t> steps_;  // numbers of samples at which the stamps stepped
    bool finished_ = false;
};

}  // namespace quorient::recording
