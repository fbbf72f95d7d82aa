#pragma once

#include "field/parameters.hpp"
#include "field/two_term_noise.hpp"

#include <cstdint>
#include <limits>

namespace quorient::fdi::field {

/// How noisy the differences between instruments are right now, measured on the differences themselves.
///
/// For every pair (i, j) the variance of one instrument's noise in one frame is followed as TwoTermNoise.
/// An instrument is judged by the noise of the *others* (median of the pairs without it): a faulty one cannot make itself inconspicuous.
/// Its own noise, as far as it is larger, widens its limits up to a bound: sound instruments may be several times noisier than their neighbours.
class NoiseScale {
public:
    NoiseScale(std::size_t instruments, double floor_rad_s, double interval_s);

    void reset();

    /// The variances that hold for a frame with this motion.
    /// @param motion  q [(rad/s)^2]
    /// @param compared  instruments that take part
    void reckon(std::size_t component, double motion, InstrumentSet compared);

    double others(std::size_t component, std::size_t m) const { return others_[component][m]; }  ///< a pair's without m [(rad/s)^2]
    double own(std::size_t component, std::size_t m) const { return own_[component][m]; }
    double typical(std::size_t component) const { return typical_[component]; }  ///< the median pair's

    /// Whether the noise of the last seconds stays below these: A [(rad/s)^2] and B, of every pair of compared instruments. A below the floor is not seen.
    bool is_within(double standing, double moving, InstrumentSet compared) const;

    /// What of this deviation is no constant: its own mean over 0.3 s is taken out.
    double quick(std::size_t component, std::size_t m, double deviation) const { return deviation - mean_[component][m]; }

    /// @param quick  deviations without their means
    /// @param clipped  deviations that the means follow
    void learn(std::size_t component, InstrumentSet present, const PerInstrument& quick, const PerInstrument& clipped);

    bool leave_one_out = true;
    double own_cap = 6;  ///< times the others' standard deviation

private:
    struct Pair {
        TwoTermNoise noise;
        double variance;
    };

    struct Ranked {
        double variance;
        std::uint8_t i;
        std::uint8_t j;
    };

    void rank(std::size_t component, double motion);
    double median_without(std::size_t component, InstrumentSet compared, std::size_t left_out) const;
    Pair& pair(std::size_t component, std::size_t i, std::size_t j) { return pairs_[component][i * max_instruments + j]; }
    const Pair& pair(std::size_t component, std::size_t i, std::size_t j) const { return pairs_[component][i * max_instruments + j]; }

    static constexpr std::size_t max_pairs = max_instruments * (max_instruments - 1) / 2;
    static constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();

    std::size_t count_;
    double floor_;  ///< A is at least this [(rad/s)^2]
    TwoTermNoise::Rates rate_;
    double mean_rate_;
    std::array<std::array<Pair, max_instruments * max_instruments>, component_count> pairs_;  ///< i < j
    std::array<std::array<Ranked, max_pairs>, component_count>
        ranked_;  ///< the pairs by their variance; kept, since it changes little from frame to frame
    std::array<PerInstrument, component_count> mean_{};
    std::array<PerInstrument, component_count> others_{};
    std::array<PerInstrument, component_count> own_{};
    std::array<double, component_count> typical_{};
    std::array<double, component_count> motion_{};
};

}  // namespace quorient::fdi::field
