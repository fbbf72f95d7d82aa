#include "detection_cells.hpp"
#include "motion_terms_fit.hpp"
#include "cli/parallel.hpp"
#include "quorient/messages/units.hpp"
#include "study.hpp"
#include "cli/program.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::studies {

namespace {

constexpr double sizes_deg_s[] = {5, 10, 22.9};

constexpr double fitted_factors[] = {1, 1.2};

fdi::MotionNoise raised(fdi::MotionNoise noise, double factor, double bias_floor_rad_s)
{
    noise.jitter_along_s *= factor;
    noise.jitter_across_s *= factor;
    noise.roughness_s *= factor;
    noise.axes_error *= factor;
    noise.rate_error *= factor;
    noise.bias_floor_rad_s = bias_floor_rad_s;
    return noise;
}

/// Terms that one recording, or half of its motion, shows.
struct Fitted {
    const Recording* recording = nullptr;
    std::string name;
    std::vector<HeldOut> seen;   ///< that the terms come from
    std::vector<HeldOut> other;  ///< the other half, for those of a half
    fdi::MotionNoise noise;
};

/// For every recording: terms from all of its motion, then from each half.
std::vector<Fitted> all_fits(const std::vector<Recording>& recordings, const RunSettings& settings, const OnProgress& on_progress)
{
    std::vector<Fitted> fits;
    for (const Recording& recording : recordings) {
        const auto halves = calibration::held_out_halves(recording.samples, recording.nominal, recording.calibration.rest);
        if (halves.size() != 2) cli::fail(fmt::format("{}: half of its motion is not enough for a calibration", recording.name));
        fits.push_back({&recording, recording.name, halves, {}, {}});
        fits.push_back({&recording, recording.name + ", one half", {halves[0]}, {halves[1]}, {}});
        fits.push_back({&recording, recording.name + ", other half", {halves[1]}, {halves[0]}, {}});
    }
    cli::for_each(fits.size(), settings.threads, on_progress, [&](std::size_t i) {
        fits[i].noise = tightest_silent(fits[i].recording->samples, fits[i].seen, fdi::usual_motion_noise(fits[i].seen.front().cluster));
    });
    return fits;
}

/// One line of the table of terms, and what they are worth where they come from and in the other half.
void add_terms(const std::string& name, const fdi::MotionNoise& noise, calibration::Samples samples, const std::vector<HeldOut>& seen,
               const std::vector<HeldOut>& other, Report& report)
{
    const Standing here = standing(samples, seen, noise);
    report.text += fmt::format("{:<24} {:>7.3f} {:>7.3f} {:>9.3f} {:>9.1e} {:>9.1e} {:>8.2f} {:>9.2f}", name, noise.jitter_along_s * 1e3,
                               noise.jitter_across_s * 1e3, noise.roughness_s * 1e3, noise.axes_error, noise.rate_error,
                               here.smallest_step_rad_s / degree, here.largest_statistic);
    Json row{{"from", name},
             {"along_s", noise.jitter_along_s},
             {"across_s", noise.jitter_across_s},
             {"outliers_s", noise.roughness_s},
             {"axes", noise.axes_error},
             {"rate", noise.rate_error},
             {"smallest_step_rad_s", here.smallest_step_rad_s},
             {"statistic", here.largest_statistic}};
    if (!other.empty()) {
        const double there = standing(samples, other, noise).largest_statistic;
        report.text += fmt::format(" {:>10.2f}", there);
        row["statistic_other_half"] = there;
    }
    report.text += '\n';
    report.json["terms"].push_back(std::move(row));
}

void add_cells(const std::vector<RecordedArray>& arrays, std::size_t place, const std::string& noise, const MonitorOf& monitor,
               const RunSettings& settings, Report& report)
{
    const HealthyRun healthy = play_healthy(arrays, place, true, monitor);
    const auto cells = violent_steps(place, sizes_deg_s);
    const auto results = play_cells(arrays, cells, monitor, settings, {});
    report.text +=
        fmt::format("{:<46} {:<16} {:>9.2f} {:>6}", arrays[place].name, noise, healthy.largest_statistic, healthy.false_isolations);
    Json row{{"array", arrays[place].name},
             {"noise", noise},
             {"largest_statistic", healthy.largest_statistic},
             {"false_isolations", healthy.false_isolations}};
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Reactions& ours = results[i].ours;
        const bool found = std::isfinite(ours.median_isolated_s);
        report.text += fmt::format(
            " {:>15}", fmt::format("{} ({} {})", found ? fmt::format("{:.3f}", ours.median_isolated_s) : "-", ours.right, ours.wrong));
        row["steps"].push_back({{"fault", cells[i].fault_name},
                                {"median_isolated_s", found ? Json(ours.median_isolated_s) : Json()},
                                {"right", ours.right},
                                {"wrong", ours.wrong}});
    }
    report.text += '\n';
    report.json["rows"].push_back(std::move(row));
}

}  // namespace

Report motion_terms(const RunSettings& settings, const OnProgress& on_progress)
{
    const auto recordings = load_recordings(settings.logs);
    if (!recordings) cli::fail(recordings.error());
    const auto arrays = cross_corrected(*recordings);
    if (!arrays) cli::fail(arrays.error());
    const auto fits = all_fits(*recordings, settings, on_progress);
    Report report;
    report.text = fmt::format(
        "The terms of the motion noise: the usual ones, and the tightest with which the detector stays at 0.85 of its threshold on a\n"
        "recording, or on half of its motion (each half played with the calibration of the other). step: smallest that the detector can\n"
        "tell, geometric mean over windows and moments; statistic: its largest there, and in the other half (1 = suspicious)\n\n"
        "{:<24} {:>7} {:>7} {:>9} {:>9} {:>9} {:>8} {:>9} {:>10}\n",
        "from", "along", "across", "outliers", "axes", "rate", "step", "statistic", "other half");
    report.text += fmt::format("{:<24} {:>7} {:>7} {:>9} {:>9} {:>9} {:>8}\n", "", "ms", "ms", "ms", "", "", "deg/s");
    for (const Fitted& fit : fits) {
        if (fit.other.empty())
            add_terms("usual, on " + fit.name, fdi::usual_motion_noise(fit.seen.front().cluster), fit.recording->samples, fit.seen, {},
                      report);
        add_terms(fit.name, fit.noise, fit.recording->samples, fit.seen, fit.other, report);
    }
    report.text += fmt::format(
        "\nEvery recording with the noise that the other one shows, by its level alone (the product) and by all its terms: without a "
        "fault,\n"
        "and steps that begin in violent motion, {} each: median time to isolation in s (right wrong)\n\n{:<46} {:<16} {:>9} {:>6}",
        settings.trials, "array", "noise", "statistic", "false");
    for (const double size : sizes_deg_s) report.text += fmt::format(" {:>15}", fmt::format("{:g} deg/s", size));
    report.text += '\n';
    for (std::size_t array = 0; array < arrays->size(); ++array) {
        add_cells(
            *arrays, array, "usual x level", [](const RecordedArray& watched, bool i) { return accumulating(watched, i); }, settings,
            report);
        for (const double factor : fitted_factors) {
            const MonitorOf fitted = [&](const RecordedArray& watched, bool instruments) {
                const double bias_floor_rad_s = fdi::usual_motion_noise(watched.cluster).bias_floor_rad_s;
                return accumulating_with(watched, instruments, raised(fits[3 * watched.calibrated_by].noise, factor, bias_floor_rad_s));
            };
            add_cells(*arrays, array, factor == 1 ? "fitted" : fmt::format("fitted x {:g}", factor), fitted, settings, report);
        }
    }
    return report;
}

}  // namespace quorient::studies
