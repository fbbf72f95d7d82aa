#pragma once

#include "single_frame/frame_detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "single_frame/weighted_parity.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::fdi {

/// Exhaustive subset likelihood: every set w of up to K faulty axes (or whole instruments) is tried, and what it leaves,
///   S_w = S0 - r_w' (P_ww)^-1 r_w   (in units of sigma^2),
/// is the log-likelihood ratio of "w" against "anything". [docs/methods/subset_likelihood.md; for one axis this is GltDetector]
///
/// Sequential: S0 within the chi-square limit of q degrees is healthy; else the smallest size at which some S_w is within the limit of
/// q - rank(P_ww) degrees decides, and the smallest S_w of that size is named, unless the margin M forbids it:
///   - another set of equal or smaller size leaves at most S_w + M: ambiguous, with all of those;
///   - no fault at all leaves at most S_w + M: suspect, with w as the likeliest culprit;
///   - w is smaller than K, and S_w is above the limit that a right w exceeds with probability `doubt`: suspect, for one more fault,
///     too small to contradict w, may be there. (Without `doubt` such pairs are named as one fault: 8 % of two faults of 5 to 30 sigma
///     on six axes at margin 9, 0.2 % with doubt 0.5; the price is half of the right isolations.) It is not held back where a further
///     fault of the share `material` of the smallest one in w would have left at least (sqrt(S_w) + sqrt(M))^2: whatever is there
///     is then too small beside what is named. (Axes only; instruments have no one size of a fault.)
/// No size within its limit: blind. Sets that explain nothing beyond a smaller one (P_ww singular) are left out.
///
/// Axes of unequal sigma are whitened first. For 4 to 24 axes, K up to q and as many sets as max_sets.
/// Not guaranteed at margin 0: two faults on six axes can look like one or like another pair.
class SubsetDetector final : public FrameDetector {
public:
    static constexpr std::size_t max_sets = 20'000;
    static constexpr double default_margin = 9;  ///< three sigma between the best explanation and the next
    static constexpr double material = 0.2;      ///< for a named fault: below, a further fault is no reason for doubt

    struct Score {
        AxisMask axes = 0;
        double statistic = 0;  ///< S_w / sigma^2
    };

    /// Settings: sigma (else from noise), pfa, max_faults (default 2, at most q), margin, doubt (default none), instruments.
    static tl::expected<std::unique_ptr<SubsetDetector>, std::string> make(const DetectorSettings& settings,
                                                                             const geometry::SensorCluster& cluster);

    /// The sets of the last frame that leave least, best first, among those tried (up to the size that decided).
    std::span<const Score> best() const { return {best_.data(), best_count_}; }

    std::vector<Detail> details(const Assessment& assessment) const override;

private:
    struct Set {
        AxisMask axes = 0;
        std::uint8_t size = 0;  ///< axes, or instruments
        std::uint8_t rank = 0;
        std::uint32_t member = 0;  ///< first of its independent axes in members_
        std::uint32_t weight = 0;  ///< first of the rows of L^-1 in weights_, (P_ww = L L'), each as long as its place
        double visibility = 0;     ///< what one more fault of size 1 leaves of S_w at least; 0 where none is allowed or seen
    };

    SubsetDetector(const geometry::SensorCluster& cluster, geometry::AxisVector sigma, const DetectorSettings& settings);

    void form(AxisMask working) override;
    void judge(const geometry::AxisVector& z, Assessment& assessment) override;

    AxisMask axes_of(AxisMask units, AxisMask working) const;
    bool adds_nothing(AxisMask units, AxisMask working, std::size_t rank) const;
    void add_set(AxisMask axes, std::size_t size, std::span<const std::uint8_t> independent);

    double visibility_beside(AxisMask axes) const;
    double left_by(const Set& set) const;
    double smallest_fault(const Set& set) const;
    void remember(const Score& score);
    void name(const Set& chosen, double statistic, std::size_t tried, Assessment& assessment) const;
    double rounding() const;

    geometry::AxisVector sigma_;
    unsigned max_faults_;
    double margin_;
    bool instruments_;
    std::size_t unit_count_;
    std::array<double, max_axes> limit_{};        ///< chi-square, by degrees of freedom
    std::array<double, max_axes> doubt_limit_{};  ///< the same for `doubt`
    WeightedParity parity_;

    std::vector<Set> sets_;  ///< by size
    std::vector<std::uint8_t> members_;
    std::vector<double> weights_;

    geometry::AxisVector residual_;  ///< the frame's, over sigma
    double sum_of_squares_ = 0;
    std::vector<double> left_;  ///< S_w of every set tried
    std::array<Score, max_candidates> best_{};
    std::size_t best_count_ = 0;
};

}  // namespace quorient::fdi
