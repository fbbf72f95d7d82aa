#pragma once

#include <cstddef>
#include <vector>

namespace quorient::fdi::field {

/// Sums over the newest frames, for every window up to Length - 1 frames: a ring of running totals. The totals begin anew with every lap of
/// the ring, so that rounding does not grow with the time since the start.
/// @tparam Record  has += and -=, and is zero when value-initialised.
template <class Record, std::size_t Length>
class RunningSums {
public:
    RunningSums() : totals_(Length) {}

    void add(const Record& frame)
    {
        if (newest_ + 1 == Length) {
            lap_ = totals_[newest_];
            newest_ = 0;
            totals_[0] = frame;
            return;
        }
        totals_[newest_ + 1] = totals_[newest_];
        totals_[++newest_] += frame;
    }

    /// @param window  1 .. Length - 2 frames up to the newest one.
    Record over(std::size_t window) const
    {
        Record sum = totals_[newest_];
        if (window > newest_) sum += lap_;
        sum -= at(window);
        return sum;
    }

    /// A total `age` frames ago, of the lap that it belongs to.
    const Record& at(std::size_t age) const { return age <= newest_ ? totals_[newest_ - age] : totals_[newest_ + Length - age]; }

    /// The part of a frame's total `age` frames ago that is known by `of`, comparable between laps.
    template <class Part>
    double total(std::size_t age, Part of) const
    {
        return age <= newest_ ? of(at(age)) : of(at(age)) - of(lap_);
    }

    void clear()
    {
        totals_.assign(Length, Record{});
        lap_ = Record{};
        newest_ = 0;
    }

private:
    std::vector<Record> totals_;
    Record lap_{};  ///< the last total of the lap before
    std::size_t newest_ = 0;
};

}  // namespace quorient::fdi::field
