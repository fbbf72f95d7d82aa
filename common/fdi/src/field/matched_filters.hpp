#pragma once

#include "field/compared_frames.hpp"
#include "field/learning.hpp"
#include "field/suspicions.hpp"
#include "field/field_detector.hpp"

namespace quorient::fdi::field {

/// Compares each instrument with the others over windows of 1 to 512 frames, through three matched filters. With D = E_m - E_o, the difference
/// to the others' mean,
///
///   C = |D| / ( zeta sqrt( Phi'(P + F)Phi (1 + 1/n_o) + N_m + sum N_j / n_o^2 ) + rho S_o ),
///
/// Phi the sums of w t phi, N of the noise (in an array of three: of the two others' pair, in windows of 0.84 s or more), S_o the others' own
/// scatter in this very window: they must agree among themselves to accuse one.
///
/// A contradiction lasts if three of the four quarters of a window of 0.4 s or more show it, and, in windows shorter than 0.84 s, if it is there in
/// the newest frames and was there 0.32 s before: a shock of up to 0.3 s never lasts.
///
/// In shorter windows a bias leaves an instrument out, and on one rigid block a gain too, where three of their quarters show it.
class MatchedFilters {
public:
    /// @param low_passed  the same sums below 2 Hz: gain and delay count only where they agree
    MatchedFilters(std::size_t instruments, double interval_s, Mount mount, const FieldRules& rules);

    /// @param age  frames that each instrument has been compared for without a break
    /// @param frame  counts frames: which windows are due
    Suspicions examine(const WindowSums& sums, const WindowSums* low_passed, const Learning& learning, InstrumentSet compared, const Ages& age,
                       std::uint64_t frame) const;

    /// The same for two instruments, which cannot be distinguished: `instrument` has no meaning.
    Suspicion disagreement(const WindowSums& sums, const Learning& learning, InstrumentSet two, const Ages& age, std::uint64_t frame) const;

private:
    struct Window;
    struct Contrast;

    Contrast contrast_of(const Window& window, const PerInstrument& deviation, const FilterSums& sums, std::size_t m) const;
    double certainty(const Contrast& contrast, Filter filter, bool lasting) const;
    bool may_pass(const Window& window, Filter filter, std::size_t m) const;
    void examine(const Window& window, Filter filter, Suspicions& found) const;
    double agreeing(const Window& window, Filter filter, std::size_t m, double certainty, bool positive) const;
    bool matters(const Window& window, std::size_t m) const;
    bool persists(const Window& window, Filter filter, std::size_t m) const;
    double contradiction_before(const Window& window, Filter filter, std::size_t m, std::size_t age) const;

    std::size_t count_;
    FieldRules rules_;
    bool brief_gains_;  ///< a gain leaves an instrument out before it lasts
    Windows windows_;
};

}  // namespace quorient::fdi::field
