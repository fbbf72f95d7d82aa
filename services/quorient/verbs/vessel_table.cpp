#include "vessel_table.hpp"

#include "vessel_run.hpp"

#include <fmt/format.h>
#include <array>
#include <cmath>

namespace quorient::cli {

namespace {

struct Window {
    const char* name;
    double from_s, to_s;
    AxisMask faulty;
};

constexpr std::array<Window, 3> windows{{{"quiet 5-20 s", 5, 20, 0}, {"gyro 26-30 s", 26, 30, 0b10}, {"sway 60-70 s", 60, 70, 0b01}}};

/// Of each window: C_a, C_g; then of the blind observers r_A1, r_A2, r_G1, r_G2. In the quiet window bounds.
constexpr std::array<std::array<double, 6>, 3> published{{{8e-6, 1.1e-5, 1e-5, 1e-5, 2e-5, 2e-5},
                                                          {.001174, .025528, .007619, .002356, 1.2e-5, .010009},
                                                          {.005240, .000168, .009997, 4e-6, .002352, .006470}}};
constexpr std::array<const char*, 6> quantities{"C_a", "C_g", "|r_A1|", "|r_A2|", "|r_G1|", "|r_G2|"};

/// Shares of samples that name the faulty channel: of the whole fault, after an independent computation.
struct Share {
    const char* name;
    double from_s, to_s;
    AxisMask faulty;
    double directional, blind;  // %
};

constexpr std::array<Share, 2> shares{{{"gyro 20-30 s", 20, 30, 0b10, 97.3, 100}, {"sway 50-70 s", 50, 70, 0b01, 92.4, 100}}};

/// What the metrics alone say: the largest above the threshold, without the detector's attribution time.
AxisMask named(const VesselRow& row, double threshold)
{
    const std::size_t larger = row.metric[1] > row.metric[0] ? 1 : 0;
    return row.metric[larger] > threshold ? axis_bit(larger) : 0;
}

struct Sums {
    std::array<std::array<double, 6>, 3> total{};
    std::array<double, 3> samples{};
    std::array<std::array<double, 2>, 2> right{};  // by fault and scheme
    std::array<double, 2> of{};
    std::array<double, 2> false_alarms{};  // by scheme
};

void add(const VesselRow& row, std::size_t scheme, double threshold, Sums& sums)
{
    // Half an interval keeps the windows' ends where they are meant to be.
    const auto within = [&](double from_s, double to_s) { return row.time_s > from_s - 0.005 && row.time_s < to_s - 0.005; };
    const AxisMask said = scheme == 0 ? named(row, threshold) : row.assessment.isolated;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (!within(windows[w].from_s, windows[w].to_s)) continue;
        if (windows[w].faulty == 0) sums.false_alarms[scheme] += said != 0 ? 1 : 0;
        if (scheme == 0) {
            sums.samples[w] += 1;
            for (std::size_t k = 0; k < 2; ++k) sums.total[w][k] += row.metric[k];
            continue;
        }
        for (std::size_t k = 0; k < 4; ++k) sums.total[w][2 + k] += std::abs(row.residual[k / 2](static_cast<Eigen::Index>(k % 2)));
    }
    for (std::size_t f = 0; f < shares.size(); ++f) {
        if (!within(shares[f].from_s, shares[f].to_s)) continue;
        sums.right[f][scheme] += said == shares[f].faulty ? 1 : 0;
        sums.of[f] += scheme == 0 ? 1 : 0;
    }
}

void print_gains(const VesselInput& input, double interval_s)
{
    constexpr std::array<std::array<double, 4>, 4> known{{{1, 2.88248337, .49438202, 2.97560976},
                                                          {1, -1.39024390, 3.28947368, .47560976},
                                                          {0, 4.90521064, 0, 3.97560976},
                                                          {3.97560976, 0, 2.27150193, 0}}};
    constexpr std::array<const char*, 4> names{"K_a", "K_g", "K_A", "K_G"};
    fmt::print("Gains (a, g: directional, poles -3, -4 and -0.5, -4; A, G: blind to the sway velocity, to the yaw rate, poles -3, -4)\n");
    fmt::print("{:<8}{:>14}{:>14}{:>12}\n", "", "ours", "recomputed", "difference");
    for (std::size_t observer = 0; observer < 4; ++observer) {
        const auto scheme = observer < 2 ? fdi::ObserverScheme::directional : fdi::ObserverScheme::blind;
        const auto bank = fdi::ObserverBank::make(input.observers(scheme), interval_s).value();
        for (std::size_t entry = 0; entry < 4; ++entry) {
            const double ours = bank.gain(observer % 2)(static_cast<Eigen::Index>(entry / 2), static_cast<Eigen::Index>(entry % 2));
            fmt::print("{} {} {}{:>16.8f}{:>14.8f}{:>12.0e}\n", names[observer], entry / 2 + 1, entry % 2 + 1, ours, known[observer][entry],
                       ours - known[observer][entry]);
        }
    }
}

void print_windows(const Sums& sums)
{
    fmt::print("\nMeans over windows\n{:<14}{:<8}{:>13}{:>13}{:>12}\n", "", "", "ours", "recomputed", "difference");
    for (std::size_t w = 0; w < windows.size(); ++w) {
        for (std::size_t k = 0; k < quantities.size(); ++k) {
            const double mean = sums.total[w][k] / sums.samples[w];
            const double other = published[w][k];
            const bool bound = windows[w].faulty == 0 && k >= 2;
            const auto verdict = bound ? (mean <= other ? "kept" : "exceeded") : fmt::format("{:+.2f} %", (mean / other - 1) * 100);
            fmt::print("{:<14}{:<8}{:>13.3e}{:>13}{:>12}\n", k == 0 ? windows[w].name : "", quantities[k], mean,
                       fmt::format("{}{:.{}e}", bound ? "<= " : "", other, other < 1e-4 ? 1 : 3), verdict);
        }
    }
}

}  // namespace

void print_vessel_table()
{
    const VesselOptions options;
    const auto input = load_vessel("").value();
    const double threshold = *input.observers(fdi::ObserverScheme::blind).threshold;
    Sums sums;
    for (std::size_t scheme = 0; scheme < 2; ++scheme) {
        const auto kind = scheme == 0 ? fdi::ObserverScheme::directional : fdi::ObserverScheme::blind;
        play(options, input, kind, [&](const VesselRow& row) {
            add(row, scheme, threshold, sums);
            return true;
        });
    }
    print_gains(input, options.interval_s);
    print_windows(sums);
    fmt::print("\nSamples of a fault that name its channel, threshold {:g}, %\n{:<14}{:>12}{:>12}{:>12}{:>12}\n", threshold, "",
               "directional", "recomputed", "blind", "recomputed");
    for (std::size_t f = 0; f < shares.size(); ++f)
        fmt::print("{:<14}{:>12.2f}{:>12.1f}{:>12.2f}{:>12.1f}\n", shares[f].name, 100 * sums.right[f][0] / sums.of[f],
                   shares[f].directional, 100 * sums.right[f][1] / sums.of[f], shares[f].blind);
    fmt::print("false alarms  {:>12}{:>12}{:>12}{:>12}\n", sums.false_alarms[0], 0, sums.false_alarms[1], 0);
}

}  // namespace quorient::cli
