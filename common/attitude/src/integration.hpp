#pragma once

#include "integration_window.hpp"

#include <memory>
#include <utility>

namespace quorient::attitude {

/// From the records of a history to the standing at the end of each: up to the newest one, and again from an older one where other axes are
/// in use than before. The same code serves both, so the result does not depend on how often it ran.
class Integration {
public:
    /// @param nominal_interval_s  for which the noise of an increment is given
    /// @param lost_after_s        coasting for longer than this: the attitude is lost
    Integration(std::unique_ptr<const Update> update, double nominal_interval_s, double lost_after_s)
        : update_(std::move(update)), nominal_interval_s_(nominal_interval_s), lost_after_s_(lost_after_s)
    {
    }

    /// Records before this index are integrated with the axes that are trusted now.
    std::size_t cursor() const { return cursor_; }
    bool has_caught_up(const History& history) const { return cursor_ == history.size(); }

    /// Integrates the record at the cursor.
    void step(History& history);

    /// One bounded slice of what is left, counted in integrated_again().
    void catch_up(History& history);

    /// The first record from this one on from which integrating again is possible: the samples that its update looks back at are still
    /// there.
    std::size_t first_restorable(const History& history, std::size_t index) const;

    /// Everything from this record on, or from the first restorable one after it, waits to be integrated again.
    void go_back_to(const History& history, std::size_t index);

    /// The oldest record leaves the history; it has been integrated.
    void forget_oldest()
    {
        assert(cursor_ > 0);
        --cursor_;
    }

    /// Nothing is integrated yet.
    void restart();

    /// A standing that is not integrated again yet, turned on by one record as it is trusted now.
    Standing follow(Standing standing, const Record& record) const;

    /// Records integrated again since this was last asked.
    std::size_t take_integrated_again() { return std::exchange(integrated_again_, 0); }

    /// What is wrong within, or nothing: the cursor, the window, and the order of standings before the cursor.
    const char* broken_invariant(const History& history) const;

private:
    static constexpr std::size_t slice = 128;

    void grow(Standing& standing, const Record& record) const;
    std::uint64_t count_after(const Standing& before, const Record& record) const;

    std::unique_ptr<const Update> update_;
    double nominal_interval_s_;
    double lost_after_s_;
    IntegrationWindow window_;
    std::size_t cursor_ = 0;
    std::size_t integrated_again_ = 0;
};

}  // namespace quorient::attitude
