#include "field/matched_filters.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace quorient::fdi::field {
namespace {

/// The low-passed residual is smaller than the whole.
constexpr double low_passed_share = 0.35;

}  // namespace

// Functions of the inner loop are inline: without it, -fPIC makes each a call.

/// One component of one window.
struct MatchedFilters::Window {
    const ComponentSums& sums;
    const ComponentSums* low_passed;
    const WindowSums& ring;
    const Learning& learning;
    std::size_t component;
    std::size_t frames;
    InstrumentSet compared;  ///< through the whole window
    std::size_t others;      ///< for each of them
    bool lasting;
};

/// One instrument against the others.
struct MatchedFilters::Contrast {
    double difference;
    double variance;
    double scatter;  ///< the others'
    std::size_t others;
};

MatchedFilters::MatchedFilters(std::size_t instruments, double interval_s, Mount mount, const FieldRules& rules)
    : count_(instruments), rules_(rules), brief_gains_(rules.brief_gains && mount == Mount::board), windows_(interval_s)
{
}

Suspicions MatchedFilters::examine(const WindowSums& sums, const WindowSums* low_passed, const Learning& learning, InstrumentSet compared,
                                   const Ages& age, std::uint64_t frame) const
{
    Suspicions found;
    for (std::size_t i = 0; i < Windows::lengths.size(); ++i) {
        const std::size_t frames = Windows::lengths[i];
        const bool lasting = windows_.is_lasting(frames);
        if (windows_.is_too_long(frames)) break;
        if (!Windows::is_due(i, frame)) continue;
        InstrumentSet through;
        for (std::size_t m = 0; m < count_; ++m) through.set(m, compared.has(m) && age[m] >= frames);
        if (through.size() < 3) continue;
        const FrameSums over = sums.over(frames);
        std::optional<FrameSums> low;
        if (low_passed != nullptr && lasting) low.emplace(low_passed->over(frames));
        for (std::size_t c = 0; c < component_count; ++c) {
            const ComponentSums& of = over.component[c];
            if (!Windows::is_even(frames, of.weight, of.weight_squared)) continue;
            const Window window{of, low ? &low->component[c] : nullptr, sums, learning, c, frames, through, through.size() - 1, lasting};
            examine(window, Filter::bias, found);
            if (frames < Windows::shortest_shaped) continue;
            if (lasting || brief_gains_) examine(window, Filter::gain, found);
            if (lasting) examine(window, Filter::delay, found);
        }
    }
    return found;
}

/// The noise of the others comes from their own. In an array of three that is known only from pairs with the accused, whose fault may look like
/// their noise; where no shock decides, that of their pair stands for it.
inline MatchedFilters::Contrast MatchedFilters::contrast_of(const Window& window, const PerInstrument& deviation, const FilterSums& sums,
                                                     std::size_t m) const
{
    Contrast contrast{};
    contrast.others = window.others;
    const auto n = static_cast<double>(contrast.others);
    double mean = 0;
    double noise = 0;
    for (std::size_t j = 0; j < count_; ++j) {
        if (j == m || !window.compared.has(j)) continue;
        mean += deviation[j] / n;
        noise += sums.noise[j];
    }
    double squares = 0;
    for (std::size_t j = 0; j < count_; ++j)
        if (j != m && window.compared.has(j)) squares += (deviation[j] - mean) * (deviation[j] - mean);
    contrast.difference = deviation[m] - mean;
    const bool by_pair = count_ == 3 && windows_.is_long(window.frames);
    contrast.variance = sums.noise[m] + (by_pair ? sums.noise_of_others[m] / n : noise / (n * n));
    contrast.scatter = std::sqrt(squares / (n - 1));
    return contrast;
}

/// `variance` holds the allowances too.
inline double MatchedFilters::certainty(const Contrast& contrast, Filter filter, bool lasting) const
{
    const double rho = rules_.others_must_agree ? Windows::scatter_factor(contrast.others - 1) : 0;
    const bool brief_gain = filter == Filter::gain && !lasting;
    const double sigmas = brief_gain ? Windows::steady_gain_sigmas : Windows::sigmas(filter != Filter::bias, lasting);
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
        if (!window.lasting && rules_.smallest_angle && !matters(window, m)) continue;  // nothing of it would count: most windows end here
        Contrast contrast = contrast_of(window, deviation, sums, m);
        contrast.variance += allowance * (1 + 1 / static_cast<double>(contrast.others));
        double certain = certainty(contrast, filter, window.lasting);
        if (window.low_passed != nullptr && window.lasting && filter != Filter::bias && certain > low_passed_share) {
            found.disturbance = std::max(found.disturbance, certain);
            certain = agreeing(window, filter, m, certain, contrast.difference > 0);
        }
        found.take({certain, m, window.component, window.frames, filter}, window.lasting, [&] { return persists(window, filter, m); },
                   [&] { return certain > found.brief_of[m] && may_pass(window, filter, m); });
    }
}

/// Whether a contradiction leaves an instrument out before it lasts: that of a bias, or a steady one of a gain, where it matters.
inline bool MatchedFilters::may_pass(const Window& window, Filter filter, std::size_t m) const
{
    const bool brief_gain = brief_gains_ && filter == Filter::gain && !window.lasting;
    if (filter != Filter::bias && !brief_gain) return false;
    if (window.lasting && rules_.smallest_angle && !matters(window, m)) return false;  // shorter ones have been asked before
    return !brief_gain || Windows::steady(window.frames, [&](std::size_t age) { return contradiction_before(window, filter, m, age); });
}

/// Whether an attitude that follows this instrument would notice.
inline bool MatchedFilters::matters(const Window& window, std::size_t m) const
{
    const PerInstrument& sums = window.sums.unclipped;
    double difference = sums[m];
    for (std::size_t j = 0; j < count_; ++j)
        if (j != m && window.compared.has(j)) difference -= sums[j] / static_cast<double>(window.others);
    return std::abs(difference) * windows_.seconds(window.frames) > windows_.least_angle_rad(window.frames) * window.sums.weight;
}

/// As certain as the low-passed residual allows: vibration that instruments see differently has no slow part.
double MatchedFilters::agreeing(const Window& window, Filter filter, std::size_t m, double certainty_of_all, bool positive) const
{
    const FilterSums& low = window.low_passed->filter[static_cast<std::size_t>(filter)];
    Contrast contrast = contrast_of(window, low.deviation, low, m);
    if ((contrast.difference > 0) != positive) return 0;
    contrast.variance += window.learning.allowance(window.component, low.regressors) * (1 + 1 / static_cast<double>(contrast.others));
    return std::min(certainty_of_all, certainty(contrast, filter, true) / low_passed_share);
}

bool MatchedFilters::persists(const Window& window, Filter filter, std::size_t m) const
{
    if (!rules_.persistence) return true;
    const Parameter parameter = parameter_of(filter, window.component);
    return windows_.persists(
        window.frames, [&](std::size_t age) { return contradiction_before(window, filter, m, age); },
        [&](std::size_t age) {
            return window.ring.total(age, [&](const FrameSums& totals) {
                return totals.component[window.component].filter[static_cast<std::size_t>(filter)].regressors(parameter);
            });
        });
}

/// The running total of an instrument's difference to the others, up to this age.
double MatchedFilters::contradiction_before(const Window& window, Filter filter, std::size_t m, std::size_t age) const
{
    const auto others = static_cast<double>(window.others);
    return window.ring.total(age, [&](const FrameSums& totals) {
        const PerInstrument& deviation = totals.component[window.component].filter[static_cast<std::size_t>(filter)].deviation;
        double difference = 0;
        for (std::size_t j = 0; j < count_; ++j)
            if (window.compared.has(j)) difference += j == m ? deviation[j] : -deviation[j] / others;
        return difference;
    });
}

Suspicion MatchedFilters::disagreement(const WindowSums& sums, const Learning& learning, InstrumentSet two, const Ages& age,
                                       std::uint64_t frame) const
{
    Suspicion most;
    std::array<std::size_t, 2> of{};
    std::size_t n = 0;
    for (std::size_t m = 0; m < count_; ++m)
        if (two.has(m)) of[n++] = m;
    for (std::size_t i = 0; i < Windows::lengths.size(); ++i) {
        const std::size_t frames = Windows::lengths[i];
        if (!Windows::is_due(i, frame) || std::min(age[of[0]], age[of[1]]) < frames || windows_.is_too_long(frames)) continue;
        const FrameSums over = sums.over(frames);
        for (std::size_t c = 0; c < component_count; ++c) {
            const FilterSums& bias_sums = over.component[c].filter[static_cast<std::size_t>(Filter::bias)];
            const double difference = std::abs(bias_sums.deviation[of[0]] - bias_sums.deviation[of[1]]);
            const double variance =
                2 * learning.allowance(c, bias_sums.regressors) + bias_sums.noise[of[0]] + bias_sums.noise[of[1]];
            const double certain = difference / (Windows::disagreement_level * Windows::lasting_sigmas * std::sqrt(variance) + 1e-300);
            if (difference * windows_.seconds(frames) <= Windows::least_lasting_angle_rad * over.component[c].weight ||
                certain <= most.certainty)
                continue;
            most = {certain, of[0], c, frames, Filter::bias};
        }
    }
    return most;
}

}  // namespace quorient::fdi::field
