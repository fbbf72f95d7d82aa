#pragma once

#include "field/window_sums.hpp"
#include "quorient/messages/units.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace quorient::fdi::field {

/// The windows that are looked at, how certain a contradiction in one of them must be, and what makes it last. One rule for whole instruments and
/// for single axes.
class Windows {
public:
    static constexpr std::array<std::size_t, 18> lengths{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, longest_window};

    /// Shorter windows have no shape to be compared with.
    static constexpr std::size_t shortest_shaped = 4;

    /// How close sound sensors come is of interest from here on.
    static constexpr double watched_from = 0.4;

    /// A suspicion counts where it exceeds the evidence against any other candidate by this factor.
    static constexpr double margin = 1.25;

    /// Where there is no other evidence for or against any candidate.
    static constexpr double disagreement_level = 1.3;

    static constexpr double lasting_sigmas = 6;

    explicit Windows(double interval_s) : interval_s_(interval_s), lock_(static_cast<std::size_t>(std::ceil(lock_s / interval_s - 1e-9))) {}

    /// A window is looked at this often in its own length: what is in between differs little.
    static std::uint64_t frames_between_looks(std::size_t window)
    {
        constexpr std::size_t looks_per_window = 8;
        return std::max<std::size_t>(1, window / looks_per_window);
    }
    static bool is_due(std::size_t index, std::uint64_t frame) { return (frame + index) % frames_between_looks(lengths[index]) == 0; }

    /// What latches comes from windows of this length at least: no shock is so long.
    bool is_lasting(std::size_t window) const { return window >= lock_; }
    bool is_too_long(std::size_t window) const { return is_lasting(window) && seconds(window) > longest_window_s; }
    /// No shock gives a window of this length its shape.
    bool is_long(std::size_t window) const { return seconds(window) >= long_s; }
    double seconds(std::size_t window) const { return static_cast<double>(window) * interval_s_; }

    /// A few frames that hold most of a window's weight are no window.
    static bool is_even(std::size_t window, double weight, double weight_squared)
    {
        constexpr double weights_alike = 0.9;
        constexpr double no_weight = 1e-14;
        const double full = static_cast<double>(std::min<std::size_t>(window, 3)) * weights_alike * weight_squared;
        return weight_squared > no_weight && weight * weight >= full;
    }

    /// Standard deviations that a brief contradiction in the shape of a gain must exceed where it is steady(). Fewer than for a bias, since no shock
    /// follows the rate.
    static constexpr double steady_gain_sigmas = lasting_sigmas;

    /// Standard deviations that a contradiction must exceed.
    static double sigmas(bool shaped, bool lasting)
    {
        constexpr double brief_sigmas = 8;
        constexpr double shaped_factor = 1.4;
        return lasting ? lasting_sigmas * (shaped ? shaped_factor : 1) : brief_sigmas;
    }

    /// How much the others' own scatter in the window counts, by the degrees of freedom that it has.
    static double scatter_factor(std::size_t freedom) { return freedom >= 3 ? 1 : 2; }

    /// Below this angle a contradiction cannot matter to the attitude. What shows in very short windows alone may be over already.
    double least_angle_rad(std::size_t window) const
    {
        constexpr double passing_s = 0.05;
        return seconds(window) < passing_s ? 0.2 * degree : least_lasting_angle_rad;
    }
    static constexpr double least_lasting_angle_rad = 0.1 * std::numbers::pi / 180;

    /// Whether three of the four quarters show a contradiction in the same sense, each with a share of its own: a shock that is shorter than two
    /// quarters cannot.
    /// @param total  of an age: running total of the contradiction up to that age
    template <class Total>
    static bool steady(std::size_t window, Total total)
    {
        constexpr std::size_t quarters = 4;
        constexpr std::size_t quarters_that_agree = 3;
        constexpr double least_share = 0.15;
        std::array<double, quarters + 1> upto{};
        for (std::size_t q = 0; q <= quarters; ++q) upto[q] = total(q * window / quarters);
        const double whole = upto[0] - upto[quarters];
        std::size_t agree = 0;
        for (std::size_t q = 0; q < quarters; ++q) {
            const double part = upto[q] - upto[q + 1];
            agree += part * whole > 0 && std::abs(part) > least_share * std::abs(whole) ? 1 : 0;
        }
        return agree >= quarters_that_agree;
    }

    /// Whether a contradiction lasts: it is steady, and in windows shorter than 0.84 s it spans more than any shock.
    /// @param total, energy  as above, and the running total of the template's square
    template <class Total, class Energy>
    bool persists(std::size_t window, Total total, Energy energy) const
    {
        return steady(window, total) && (is_long(window) || spans(window, total, energy));
    }

private:
    static constexpr double lock_s = 0.40;
    static constexpr double long_s = 0.84;
    static constexpr double longest_window_s = 8.2;

    /// The newest frames, and those of 0.32 s ago, contradict at least half as much as the whole window.
    template <class Total, class Energy>
    bool spans(std::size_t window, Total total, Energy energy) const
    {
        constexpr double spanned_s = 0.32;
        constexpr double part_s = 0.05;
        constexpr double least_share = 0.5;
        const auto part = static_cast<std::size_t>(std::max(1L, std::lround(part_s / interval_s_)));
        const auto early = static_cast<std::size_t>(std::ceil(spanned_s / interval_s_ - 1e-9));
        const auto size_in = [&](std::size_t newest, std::size_t oldest) {
            const double of = energy(newest) - energy(oldest);
            return of > 0 ? (total(newest) - total(oldest)) / of : 0;
        };
        const std::size_t begin = early + part;
        if (begin > window) return false;
        const double whole = size_in(0, begin);
        return size_in(0, part) / whole > least_share && size_in(early, begin) / whole > least_share;
    }

    double interval_s_;
    std::size_t lock_;  ///< frames of the shortest window that latches
};

}  // namespace quorient::fdi::field
