#pragma once

#include "field/compared_frames.hpp"
#include "field/suspicions.hpp"
#include "field/field_detector.hpp"
#include "skewed/axis_sums.hpp"

namespace quorient::fdi::skewed {

/// Compares each axis with the others over windows of 1 to 512 frames, through two matched filters: a bias, and a gain along its own direction h.
/// With D the sums of w t r in the parity space of the window's axes, and d = D_j / sqrt(P_jj) its part along the parity of axis j,
///
///   C = |d| / ( zeta sqrt( Phi'(P + F)Phi + sum_i P_ji^2 N_i / P_jj ) + rho sqrt(P_jj) S ),
///
/// Phi the sums of w t phi, N of the noise, S the root mean square of the parity that axis j does not explain: the others must agree among
/// themselves to accuse one. Windows, limits, persistence: field::Windows.
class AxisFilters {
public:
    AxisFilters(const geometry::Axes& axes, double interval_s, const FieldRules& rules);

    /// @param age  frames that each axis has been compared for without a break
    /// @param frame  counts frames: which windows are due
    /// @returns suspicions of axes: `instrument` is the axis, `component` says nothing.
    field::Suspicions examine(const AxisWindows& sums, const Allowance& allowance, AxisSet compared, const field::Ages& age,
                              std::uint64_t frame) const;

    /// The same for axes that leave one parity only, and cannot be distinguished: `instrument` has no meaning.
    field::Suspicion disagreement(const AxisWindows& sums, const Allowance& allowance, AxisSet compared, const field::Ages& age,
                                  std::uint64_t frame) const;

private:
    struct Window;
    struct Contrast;

    void examine(const Window& window, std::size_t axis, field::Filter filter, const PerAxis& residual, field::Suspicions& found) const;
    double noise_along(const AxisParity& parity, std::size_t axis, const PerAxis& noise) const;
    bool matters(const Window& window, std::size_t axis) const;
    bool persists(const Window& window, std::size_t axis, const Direction& shape) const;

    geometry::Axes axes_;
    std::size_t count_;
    FieldRules rules_;
    field::Windows windows_;
};

}  // namespace quorient::fdi::skewed
