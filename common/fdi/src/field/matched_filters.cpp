#include "field/matched_filters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quorient::fdi::field {
namespace {

constexpr std::array<std::size_t, 18> windows{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, longest_window};
constexpr double longest_window_s = 8.2;

/// A window is looked at this often in its own length: what is in between differs little.
constexpr std::size_t looks_per_window = 8;

/// Shorter windows have no shape to be compared with.
constexpr std::size_t shortest_shaped = 4;

/// What latches comes from windows of this length at least: no shock is so long.
constexpr double lock_s = 0.40;

constexpr double brief_sigmas = 8;
constexpr double lasting_sigmas = 6;
constexpr double shaped_factor = 1.4;

constexpr double scatter_factor = 2;
constexpr double scatter_factor_of_many = 1;
constexpr std::size_t many = 4;

/// Below this angle a contradiction cannot matter to the attitude.
constexpr double least_angle_rad = 0.1 * std::numbers::pi / 180;

/// What shows in shorter windows than this alone may be over already, and must be larger.
constexpr double passing_s = 0.05;
constexpr double least_passing_angle_rad = 0.2 * std::numbers::pi / 180;

constexpr std::size_t quarters = 4;
constexpr std::size_t quarters_that_agree = 3;
constexpr double least_share_of_quarter = 0.15;

/// Shorter windows than this must also show that the contradiction spans more than any shock.
constexpr double long_s = 0.84;
constexpr double spanned_s = 0.32;
constexpr double part_s = 0.05;
constexpr double least_share_of_whole = 0.5;

/// How close sound instruments come is of interest from here on.
constexpr double watched_from = 0.4;

/// A few frames that hold most of a window's weight are no window.
constexpr double weights_alike = 0.9;
constexpr double no_weight = 1e-14;

/// The low-passed residual is smaller than the whole.
constexpr double low_passed_share = 0.35;

/// With two instruments nothing else speaks for or against.
constexpr double disagreement_level = 1.3;

}  // namespace

/// One component of one window.
struct MatchedFilters::Window {
    const ComponentSums& sums;
    const ComponentSums* low_passed;
    const WindowSums& ring;
    const Learning& learning;
    std::size_t component;
    std::size_t frames;
    InstrumentSet compared;  ///< through the whole window
    bool lasting;
};

/// One instrument against the others.
struct MatchedFilters::Contrast {
    double difference;
    double variance;
    double scatter;  ///< of the others
    std::size_t others;
};

double Suspicions::against_others(std::size_t m) const
{
    double largest = 0;
    for (std::size_t j = 0; j < max_instruments; ++j)
        if (j != m) largest = std::max({largest, brief_of[j], lasting_of[j]});
    return largest;
}

double Suspicions::lasting_against_others(std::size_t m) const
{
    double largest = 0;
    for (std::size_t j = 0; j < max_instruments; ++j)
        if (j != m) largest = std::max(largest, lasting_of[j]);
    return largest;
}

MatchedFilters::MatchedFilters(std::size_t instruments, double interval_s, const FieldRules& rules)
    : count_(instruments), interval_s_(interval_s), rules_(rules), lock_(static_cast<std::size_t>(std::ceil(lock_s / interval_s - 1e-9)))
{
}

std::uint64_t MatchedFilters::frames_between_looks(std::size_t window)
{
    return std::max<std::size_t>(1, window / looks_per_window);
}

bool MatchedFilters::is_due(std::size_t index, std::uint64_t frame) const
{
    return (frame + index) % frames_between_looks(windows[index]) == 0;
}

Suspicions MatchedFilters::examine(const WindowSums& sums, const WindowSums* low_passed, const Learning& learning, InstrumentSet compared,
                                   const Ages& age, std::uint64_t frame) const
{
    Suspicions found;
    for (std::size_t i = 0; i < windows.size(); ++i) {
        const std::size_t frames = windows[i];
        const bool lasting = frames >= lock_;
        if (lasting && static_cast<double>(frames) * interval_s_ > longest_window_s) break;
        if (!is_due(i, frame)) continue;
        InstrumentSet through;
        for (std::size_t m = 0; m < count_; ++m) through.set(m, compared.has(m) && age[m] >= frames);
        if (through.size() < 3) continue;
        const FrameSums over = sums.over(frames);
        const FrameSums low = low_passed != nullptr && lasting ? low_passed->over(frames) : FrameSums{};
        for (std::size_t c = 0; c < component_count; ++c) {
            const ComponentSums& of = over.component[c];
            const double full = static_cast<double>(std::min<std::size_t>(frames, 3)) * weights_alike * of.weight_squared;
            if (!(of.weight_squared > no_weight) || of.weight * of.weight < full) continue;
            const Window window{of, low_passed != nullptr ? &low.component[c] : nullptr, sums, learning, c, frames, through, lasting};
            examine(window, Filter::bias, found);
            if (frames < shortest_shaped) continue;
            examine(window, Filter::gain, found);
            examine(window, Filter::delay, found);
        }
    }
    return found;
}

MatchedFilters::Contrast MatchedFilters::contrast_of(const Window& window, const PerInstrument& deviation, const PerInstrument& own_noise,
                                                     std::size_t m) const
{
    Contrast contrast{};
    contrast.others = window.compared.size() - 1;
    const auto n = static_cast<double>(contrast.others);
    double mean = 0;
    double noise = 0;
    for (std::size_t j = 0; j < count_; ++j) {
        if (j == m || !window.compared.has(j)) continue;
        mean += deviation[j] / n;
        noise += own_noise[j];
    }
    double squares = 0;
    for (std::size_t j = 0; j < count_; ++j)
        if (j != m && window.compared.has(j)) squares += (deviation[j] - mean) * (deviation[j] - mean);
    contrast.difference = deviation[m] - mean;
    contrast.variance = own_noise[m] + noise / (n * n);
    contrast.scatter = std::sqrt(squares / (n - 1));
    return contrast;
}

/// `variance` holds the allowances too.
double MatchedFilters::certainty(const Contrast& contrast, Filter filter, bool lasting) const
{
    const double sigmas = lasting ? lasting_sigmas * (filter == Filter::bias ? 1 : shaped_factor) : brief_sigmas;
    const double rho = !rules_.others_must_agree ? 0 : contrast.others >= many ? scatter_factor_of_many : scatter_factor;
    const double bound = sigmas * std::sqrt(contrast.variance) + rho * contrast.scatter;
    return bound > 0 ? std::abs(contrast.difference) / bound : 0;
}

void MatchedFilters::examine(const Window& window, Filter filter, Suspicions& found) const
{
    const FilterSums& sums = window.sums.filter[static_cast<std::size_t>(filter)];
    const double allowance = window.learning.allowance(window.component, sums.regressors);
    // What lasts is counted clipped, so that no shock can make it; what may pass is counted as it is.
    const PerInstrument& deviation = window.lasting || filter != Filter::bias ? sums.deviation : window.sums.unclipped;
    for (std::size_t m = 0; m < count_; ++m) {
        if (!window.compared.has(m)) continue;
        Contrast contrast = contrast_of(window, deviation, sums.noise, m);
        contrast.variance += allowance * (1 + 1 / static_cast<double>(contrast.others));
        double certain = certainty(contrast, filter, window.lasting);
        if (window.low_passed != nullptr && window.lasting && filter != Filter::bias && certain > low_passed_share) {
            found.disturbance = std::max(found.disturbance, certain);
            certain = agreeing(window, filter, m, certain, contrast.difference > 0);
        }
        const Suspicion suspicion{certain, m, window.component, window.frames, filter};
        const bool lasts = window.lasting && certain > std::max(watched_from, std::min(1.0, found.closest)) && persists(window, filter, m);
        if (lasts) found.closest = std::max(found.closest, certain);
        if (window.lasting && (certain <= 1 || lasts)) {
            found.lasting_of[m] = std::max(found.lasting_of[m], certain);
            found.disturbance = std::max(found.disturbance, certain);
            if (certain > found.lasting.certainty) found.lasting = suspicion;
            continue;
        }
        if (filter != Filter::bias || (rules_.smallest_angle && !matters(window, m))) continue;
        found.brief_of[m] = std::max(found.brief_of[m], certain);
        if (certain > found.brief.certainty) found.brief = suspicion;
    }
}

/// Whether an attitude that follows this instrument would notice.
bool MatchedFilters::matters(const Window& window, std::size_t m) const
{
    const PerInstrument& sums = window.sums.unclipped;
    double difference = sums[m];
    for (std::size_t j = 0; j < count_; ++j)
        if (j != m && window.compared.has(j)) difference -= sums[j] / static_cast<double>(window.compared.size() - 1);
    const double seconds = static_cast<double>(window.frames) * interval_s_;
    return std::abs(difference) * seconds > (seconds < passing_s ? least_passing_angle_rad : least_angle_rad) * window.sums.weight;
}

/// As certain as the low-passed residual allows: vibration that instruments see differently has no slow part.
double MatchedFilters::agreeing(const Window& window, Filter filter, std::size_t m, double certainty_of_all, bool positive) const
{
    const FilterSums& low = window.low_passed->filter[static_cast<std::size_t>(filter)];
    Contrast contrast = contrast_of(window, low.deviation, low.noise, m);
    if ((contrast.difference > 0) != positive) return 0;
    contrast.variance += window.learning.allowance(window.component, low.regressors) * (1 + 1 / static_cast<double>(contrast.others));
    return std::min(certainty_of_all, certainty(contrast, filter, true) / low_passed_share);
}

bool MatchedFilters::persists(const Window& window, Filter filter, std::size_t m) const
{
    if (!rules_.persistence) return true;
    const bool is_long = static_cast<double>(window.frames) * interval_s_ >= long_s;
    return in_three_quarters(window, filter, m) && (is_long || spans(window, filter, m));
}

/// The running total of an instrument's difference to the others, up to this age.
double MatchedFilters::contradiction_before(const Window& window, Filter filter, std::size_t m, std::size_t age) const
{
    const auto others = static_cast<double>(window.compared.size() - 1);
    return window.ring.total(age, [&](const FrameSums& totals) {
        const PerInstrument& deviation = totals.component[window.component].filter[static_cast<std::size_t>(filter)].deviation;
        double difference = 0;
        for (std::size_t j = 0; j < count_; ++j)
            if (window.compared.has(j)) difference += j == m ? deviation[j] : -deviation[j] / others;
        return difference;
    });
}

/// The newest frames, and those of 0.32 s ago, contradict at least half as much as the whole window.
bool MatchedFilters::spans(const Window& window, Filter filter, std::size_t m) const
{
    const auto part = static_cast<std::size_t>(std::max(1L, std::lround(part_s / interval_s_)));
    const auto early = static_cast<std::size_t>(std::ceil(spanned_s / interval_s_ - 1e-9));
    const auto energy_before = [&](std::size_t age) {
        return window.ring.total(age, [&](const FrameSums& totals) {
            return totals.component[window.component].filter[static_cast<std::size_t>(filter)].regressors(parameter_of(filter, window.component));
        });
    };
    const auto size_in = [&](std::size_t newest, std::size_t oldest) {
        const double energy = energy_before(newest) - energy_before(oldest);
        return energy > 0 ? (contradiction_before(window, filter, m, newest) - contradiction_before(window, filter, m, oldest)) / energy : 0;
    };
    const std::size_t begin = early + part;
    if (begin > window.frames) return false;
    const double whole = size_in(0, begin);
    return size_in(0, part) / whole > least_share_of_whole && size_in(early, begin) / whole > least_share_of_whole;
}

/// Three of the four quarters contradict in the same sense, each with a share of its own: a shock that is shorter than two quarters cannot.
bool MatchedFilters::in_three_quarters(const Window& window, Filter filter, std::size_t m) const
{
    std::array<double, quarters + 1> upto{};
    for (std::size_t q = 0; q <= quarters; ++q) upto[q] = contradiction_before(window, filter, m, q * window.frames / quarters);
    const double whole = upto[0] - upto[quarters];
    std::size_t agree = 0;
    for (std::size_t q = 0; q < quarters; ++q) {
        const double part = upto[q] - upto[q + 1];
        agree += part * whole > 0 && std::abs(part) > least_share_of_quarter * std::abs(whole) ? 1 : 0;
    }
    return agree >= quarters_that_agree;
}

Suspicion MatchedFilters::disagreement(const WindowSums& sums, const Learning& learning, InstrumentSet two, const Ages& age,
                                       std::uint64_t frame) const
{
    Suspicion most;
    std::array<std::size_t, 2> of{};
    std::size_t n = 0;
    for (std::size_t m = 0; m < count_; ++m)
        if (two.has(m)) of[n++] = m;
    for (std::size_t i = 0; i < windows.size(); ++i) {
        const std::size_t frames = windows[i];
        const double seconds = static_cast<double>(frames) * interval_s_;
        if (!is_due(i, frame) || std::min(age[of[0]], age[of[1]]) < frames || (frames >= lock_ && seconds > longest_window_s)) continue;
        const FrameSums over = sums.over(frames);
        for (std::size_t c = 0; c < component_count; ++c) {
            const FilterSums& bias_sums = over.component[c].filter[static_cast<std::size_t>(Filter::bias)];
            const double difference = std::abs(bias_sums.deviation[of[0]] - bias_sums.deviation[of[1]]);
            const double variance =
                2 * learning.allowance(c, bias_sums.regressors) + bias_sums.noise[of[0]] + bias_sums.noise[of[1]];
            const double certain = difference / (disagreement_level * lasting_sigmas * std::sqrt(variance) + 1e-300);
            if (difference * seconds <= least_angle_rad * over.component[c].weight || certain <= most.certainty) continue;
            most = {certain, of[0], c, frames, Filter::bias};
        }
    }
    return most;
}

}  // namespace quorient::fdi::field
