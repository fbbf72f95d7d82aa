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

/// Rows are windows: C_a, C_g; then of the blind observers r_A1, r_A2, r_G1, r_G2. In the quiet window bounds.
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

// The gains K_a, K_g (directional) and K_A, K_G (blind), recomputed from the repaired equations, by rows.
constexpr std::array<std::array<double, 4>, 4> known_gains{{{1, 2.88248337, .49438202, 2.97560976},
                                                          {1, -1.39024390, 3.28947368, .47560976},
                                                          {0, 4.90521064, 0, 3.97560976},
                                                          {3.97560976, 0, 2.27150193, 0}}};
constexpr std::array<const char*, 4> gain_names{"K_a", "K_g", "K_A", "K_G"};

using Gains = std::array<std::array<double, 4>, 4>;  // by observer, then by rows

Gains gains_of(const VesselInput& input, double interval_s)
{
    Gains gains{};
    for (std::size_t observer = 0; observer < 4; ++observer) {
        const auto scheme = observer < 2 ? fdi::ObserverScheme::directional : fdi::ObserverScheme::blind;
        const auto bank = fdi::ObserverBank::make(input.observers(scheme), interval_s).value();
        for (std::size_t entry = 0; entry < 4; ++entry)
            gains[observer][entry] =
                bank.gain(observer % 2)(static_cast<Eigen::Index>(entry / 2), static_cast<Eigen::Index>(entry % 2));
    }
    return gains;
}

void print_gains(const Gains& gains)
{
    fmt::print("Gains (a, g: directional, poles -3, -4 and -0.5, -4; A, G: blind to the sway velocity, to the yaw rate, poles -3, -4)\n");
    fmt::print("{:<8}{:>14}{:>14}{:>12}\n", "", "ours", "recomputed", "difference");
    for (std::size_t observer = 0; observer < 4; ++observer) {
        for (std::size_t entry = 0; entry < 4; ++entry) {
            const double ours = gains[observer][entry];
            const double known = known_gains[observer][entry];
            fmt::print("{} {} {}{:>16.8f}{:>14.8f}{:>12.0e}\n", gain_names[observer], entry / 2 + 1, entry % 2 + 1, ours, known, ours - known);
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

/// Both schemes over the paper's run.
struct Table {
    Gains gains;
    Sums sums;
    double threshold;
};

Table table()
{
    const VesselOptions options;
    const auto input = load_vessel("").value();
    Table result{gains_of(input, options.interval_s), {}, *input.observers(fdi::ObserverScheme::blind).threshold};
    for (std::size_t scheme = 0; scheme < 2; ++scheme) {
        const auto kind = scheme == 0 ? fdi::ObserverScheme::directional : fdi::ObserverScheme::blind;
        play(options, input, kind, [&](const VesselRow& row) {
            add(row, scheme, result.threshold, result.sums);
            return true;
        });
    }
    return result;
}

double share(const Sums& sums, std::size_t fault, std::size_t scheme)
{
    return 100 * sums.right[fault][scheme] / sums.of[fault];
}

Json windows_json(const Sums& sums)
{
    Json json = Json::array();
    for (std::size_t w = 0; w < windows.size(); ++w)
        for (std::size_t k = 0; k < quantities.size(); ++k)
            json.push_back({{"window", windows[w].name},
                            {"quantity", quantities[k]},
                            {"mean", sums.total[w][k] / sums.samples[w]},
                            {"recomputed", published[w][k]},
                            {"is_bound", windows[w].faulty == 0 && k >= 2}});
    return json;
}

}  // namespace

void print_vessel_table()
{
    const auto [gains, sums, threshold] = table();
    print_gains(gains);
    print_windows(sums);
    fmt::print("\nSamples of a fault that name its channel, threshold {:g}, %\n{:<14}{:>12}{:>12}{:>12}{:>12}\n", threshold, "",
               "directional", "recomputed", "blind", "recomputed");
    for (std::size_t f = 0; f < shares.size(); ++f)
        fmt::print("{:<14}{:>12.2f}{:>12.1f}{:>12.2f}{:>12.1f}\n", shares[f].name, share(sums, f, 0), shares[f].directional,
                   share(sums, f, 1), shares[f].blind);
    fmt::print("false alarms  {:>12}{:>12}{:>12}{:>12}\n", sums.false_alarms[0], 0, sums.false_alarms[1], 0);
}

Json vessel_table_json()
{
    const auto [gains, sums, threshold] = table();
    Json json;
    for (std::size_t observer = 0; observer < 4; ++observer)
        json["gains"].push_back({{"name", gain_names[observer]}, {"gain", gains[observer]}, {"recomputed", known_gains[observer]}});
    json["windows"] = windows_json(sums);
    json["threshold"] = threshold;
    for (std::size_t f = 0; f < shares.size(); ++f)
        json["named_percent"].push_back(
            {{"fault", shares[f].name},
             {"directional", {{"share", share(sums, f, 0)}, {"recomputed", shares[f].directional}}},
             {"blind", {{"share", share(sums, f, 1)}, {"recomputed", shares[f].blind}}}});
    json["false_alarms"] = {{"directional", sums.false_alarms[0]}, {"blind", sums.false_alarms[1]}};
    return json;
}

}  // namespace quorient::cli
