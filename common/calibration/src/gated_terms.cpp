#include "quorient/calibration/gated_terms.hpp"

#include "quorient/calibration/held_out.hpp"
#include "quorient/fdi/array_sums.hpp"
#include "quorient/fdi/noise.hpp"
#include "quorient/calibration/term_search.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <vector>

namespace quorient::calibration {

namespace {


constexpr std::array<std::size_t, 7> window_lengths{8, 16, 32, 64, 128, 256, 512};
static_assert(window_lengths.back() == fdi::ArraySums::longest_window);

constexpr std::size_t order = 10;                       // the tenth largest value decides
constexpr std::size_t least_values = 4 * order;         // a window with fewer values does not count
constexpr std::size_t least_instruments = 3;            // with two the wrong one cannot be named
constexpr std::size_t least_for_triples = 5;            // from so many on triples are tried too: their mean is less certain
constexpr std::array<std::size_t, 3> triples{1, 4, 7};  // first instrument of each
constexpr TermSearchSettings search{.close_enough = 0.015, .level_rounds = 8, .sweeps = 4};

/// Logarithms: along, across, axes, rate.
using Place = TermPlace<4>;
using Logs = decltype(Place::logs);

fdi::MotionNoise noise_of(const Logs& logs, double bias_floor_rad_s = 0)
{
    return {.jitter_along_s = std::exp(logs[0]),
            .jitter_across_s = std::exp(logs[1]),
            .axes_error = std::exp(logs[2]),
            .rate_error = std::exp(logs[3]),
            .bias_floor_rad_s = bias_floor_rad_s};
}

/// The largest of many values, and how many there were.
class Largest {
public:
    void add(double value)
    {
        ++count_;
        if (largest_.size() < order) largest_.push(value);
        else if (value > largest_.top()) {
            largest_.pop();
            largest_.push(value);
        }
    }

    std::size_t count() const { return count_; }
    double tenth() const { return largest_.top(); }

private:
    std::priority_queue<double, std::vector<double>, std::greater<>> largest_;  ///< the smallest on top
    std::size_t count_ = 0;
};

/// What one length of windows shows.
struct Shown {
    Largest chi_square{};  ///< three degrees of freedom; windows overlap by half
    double log_step = 0;               ///< sum of logarithms, over axes and windows end to end
    double steps = 0;
};

class Fit {
public:
    Fit(Samples samples, const std::vector<HeldOut>& halves, std::vector<fdi::InstrumentArray> arrays)
        : samples_(samples),
          halves_(halves),
          arrays_(std::move(arrays)),
          floor_(fdi::usual_motion_noise(halves.front().cluster).bias_floor_rad_s)
    {
    }

    /// @returns nothing where no length of windows has enough of them.
    std::optional<fdi::MotionNoise> result()
    {
        const auto usual = fdi::usual_motion_noise(halves_.front().cluster);
        const Place start =
            seen({std::log(usual.jitter_along_s), std::log(usual.jitter_across_s), std::log(usual.axes_error), std::log(usual.rate_error)});
        if (!std::isfinite(start.excess)) return std::nullopt;
        const auto look = [this](const Logs& logs) { return seen(logs); };
        const Logs logs = TermSearch<4, decltype(look)>(start, look, search).result();
        return noise_of(logs);
    }

private:
    /// All instruments, then some triples.
    std::vector<AxisMask> exclusions(const HeldOut& half) const
    {
        const std::size_t count = half.cluster.instrument_name.size();
        std::vector<AxisMask> masks{0};
        if (count < least_for_triples) return masks;
        for (const std::size_t m : triples) {
            AxisMask kept = 0;
            for (const std::size_t place : {m, m + 2, m + 4}) kept |= half.cluster.axes_of(place % count);
            masks.push_back(half.cluster.all() & ~kept);
        }
        return masks;
    }

    static void add_window(const fdi::ArraySums& sums, std::size_t length, bool with_steps, double interval_s, Shown& shown)
    {
        const auto fit = sums.fit(length);
        for (std::size_t m = 0; m < sums.array().size(); ++m) {
            if (!sums.array().compared(m)) continue;
            const auto [u, q] = fit.contradiction(m);
            shown.chi_square.add(u.dot(q.inverse() * u));
            const auto& instrument = sums.array()[m];
            for (std::size_t i = 0; with_steps && i < instrument.size; ++i) {
                const Eigen::Vector3d direction = fit.weight * instrument.body_from_axes.col(static_cast<Eigen::Index>(i)) * interval_s;
                shown.log_step -= std::log(direction.dot(q * direction)) / 2;
                ++shown.steps;
            }
        }
    }

    void add_half(const HeldOut& half, fdi::ArraySums& sums, bool all, std::array<Shown, window_lengths.size()>& shown) const
    {
        for (const auto& stretch : half.stretches) {
            sums.reset();
            half.play(samples_, stretch, [&](std::size_t i, const fdi::Measurement& measurement) {
                if (sums.add(measurement) != fdi::ArraySums::Added::counted) return;
                for (std::size_t w = 0; w < window_lengths.size(); ++w) {
                    const std::size_t length = window_lengths[w];
                    if (i < stretch.begin + length || (i - stretch.begin) % (length / 2) != 0 || sums.size() <= length) continue;
                    add_window(sums, length, all && (i - stretch.begin) % length == 0, half.cluster.interval_s, shown[w]);
                }
            });
        }
    }

    Place seen(const Logs& logs) const
    {
        std::array<Shown, window_lengths.size()> shown;
        for (std::size_t h = 0; h < halves_.size(); ++h)
            for (const AxisMask excluded : exclusions(halves_[h])) {
                fdi::ArraySums sums(arrays_[h], noise_of(logs, floor_), fdi::chi_square_quantile(3, fdi::ArraySums::gate_tail));
                sums.exclude(excluded);
                add_half(halves_[h], sums, excluded == 0, shown);
            }
        Place place{.logs = logs, .excess = -std::numeric_limits<double>::infinity()};
        double lengths = 0;
        for (const Shown& window : shown) {
            if (window.chi_square.count() < least_values || window.steps == 0) continue;
            const double tail = (static_cast<double>(order) - 0.5) / static_cast<double>(window.chi_square.count());
            place.excess = std::max(place.excess, std::log(window.chi_square.tenth() / fdi::chi_square_quantile(3, tail)) / 2);
            place.step += window.log_step / window.steps;
            ++lengths;
        }
        if (lengths > 0) place.step /= lengths;
        return place;
    }

    Samples samples_;
    const std::vector<HeldOut>& halves_;
    std::vector<fdi::InstrumentArray> arrays_;  ///< one for each half
    double floor_;
};

}  // namespace

std::optional<fdi::MotionNoise> gated_terms(Samples samples, const ClusterDescription& nominal, const Calibration& calibration,
                                      const RestSettings& settings)
{
    if (!calibration.motion || calibration.motion->noise.samples == 0 || !calibration.outside.empty()) return std::nullopt;
    const auto halves = held_out_halves(samples, nominal, calibration.rest, settings);
    if (halves.empty() || halves.front().cluster.instrument_name.size() < least_instruments) return std::nullopt;
    std::vector<fdi::InstrumentArray> arrays;
    for (const HeldOut& half : halves) {
        const auto sigma = fdi::sigma_of_axes({}, half.cluster);
        if (!sigma || !(half.cluster.interval_s > 0)) return std::nullopt;
        auto array = fdi::InstrumentArray::make(half.cluster, sigma->cwiseAbs2());
        if (!array) return std::nullopt;
        arrays.push_back(std::move(*array));
    }
    return Fit(samples, halves, std::move(arrays)).result();
}

}  // namespace quorient::calibration
