#include "calibration_report.hpp"

#include "mounting_report.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::cli {

namespace {

using calibration::Calibration;
using calibration::OutsideClass;
using calibration::Samples;

std::string axis_name(const Calibration& calibration, std::size_t axis)
{
    const auto& description = calibration.cluster.description;
    const auto& name = description.instrument_name[description.instrument[axis]];
    return {name.begin(), std::find(name.begin(), name.end(), '\0')};
}

Json axis_json(const Calibration& calibration, std::size_t axis)
{
    const auto& cluster = calibration.cluster;
    const bool rested = !calibration.rest.empty();
    const auto row = static_cast<Eigen::Index>(axis);
    return {{"axis", axis},
            {"instrument", axis_name(calibration, axis)},
            {"bias_rad_s", cluster.description.bias[axis]},
            {"bias_spread_rad_s", calibration.rest.size() > 1 ? Json(cluster.bias_spread_rad_s[axis]) : Json()},
            {"sigma_rad", cluster.description.sigma[axis]},
            {"gain", cluster.gain[axis]},
            {"direction", cluster.description.axis[axis]},
            {"misalignment_rad", calibration.misalignment_rad[axis]},
            {"random_walk_rad_sqrt_s", rested ? Json(calibration.allan_figures.random_walk_rad_sqrt_s(row)) : Json()},
            {"bias_instability_rad_s", rested ? Json(calibration.allan_figures.bias_instability_rad_s(row)) : Json()},
            {"limit_rad_s", calibration.saturation_limit_rad_s[axis] > 0 ? Json(calibration.saturation_limit_rad_s[axis]) : Json()},
            {"saturated", calibration.saturated[axis]}};
}

std::string_view word_of(OutsideClass::Kind kind)
{
    switch (kind) {
        case OutsideClass::Kind::sign: return "sign";
        case OutsideClass::Kind::bias: return "bias";
        case OutsideClass::Kind::gain: break;
    }
    return "gain";
}

Json outside_json(const Calibration& calibration)
{
    Json list = Json::array();
    for (const OutsideClass& outside : calibration.outside)
        list.push_back({{"axis", outside.axis},
                        {"name", quorient::axis_name(calibration.cluster.description, outside.axis)},
                        {"kind", word_of(outside.kind)},
                        {"gain", outside.gain},
                        {"gain_sigma", outside.gain_sigma},
                        {"bias_rad_s", outside.bias_rad_s},
                        {"bias_sigma_rad_s", outside.bias_sigma_rad_s}});
    return list;
}

std::string outside_text(const Calibration& calibration)
{
    std::string text;
    for (const OutsideClass& outside : calibration.outside) {
        const std::string name = quorient::axis_name(calibration.cluster.description, outside.axis);
        if (outside.kind == OutsideClass::Kind::bias)
            text += fmt::format("axis {} reads {:+.1f} +- {:.1f} deg/s beyond what the others measure: faulty", name, outside.bias_rad_s / degree,
                                outside.bias_sigma_rad_s / degree);
        else
            text += fmt::format("axis {} measures {:.2f} +- {:.2f} of what the others measure: faulty or wrongly mounted", name, outside.gain,
                                outside.gain_sigma);
        text += "; set aside, not calibrated\n";
    }
    return text;
}

Json replay_json(const Calibration& calibration, const Searches& searches)
{
    if (!searches.silence) return {};
    Json list = Json::array();
    for (const calibration::Replayed& replayed : searches.silence->replayed)
        list.push_back({{"method", replayed.method},
                        {"isolated", replayed.isolated != 0 ? Json(axis_names(calibration.cluster.description, replayed.isolated)) : Json()},
                        {"first_s", replayed.isolated != 0 ? Json(replayed.first_s) : Json()}});
    return list;
}

/// What a replay would make of this recording, and where a search found no end.
std::string searches_text(const Calibration& calibration, const Searches& searches)
{
    std::string text;
    if (searches.level && searches.level->at_limit)
        text += "motion noise: the search for its level ended at its limit; the accumulating detector is not to be trusted with it\n";
    if (!searches.silence) return text;
    for (const calibration::Replayed& replayed : searches.silence->replayed)
        text += replayed.isolated == 0
                    ? fmt::format("replayed with this calibration, {} isolates nobody\n", replayed.method)
                    : fmt::format("replayed with this calibration, {} isolates {}, from {:.2f} s on\n", replayed.method,
                                  axis_names(calibration.cluster.description, replayed.isolated), replayed.first_s);
    if (searches.silence->at_limit) text += "the level of the motion noise that silences accumulating was not found\n";
    return text;
}

Json gated_json(const Calibration& calibration)
{
    const auto& gated = calibration.cluster.gated;
    if (!gated) return {};
    return {{"along_s", gated->jitter_along_s}, {"across_s", gated->jitter_across_s}, {"axes", gated->axes_error}, {"rate", gated->rate_error}};
}

Json motion_json(const Calibration& calibration, const Searches& searches)
{
    if (!calibration.motion) return {};
    const auto& motion = *calibration.motion;
    Json windows = Json::array();
    for (const auto& window : motion.windows)
        if (window.windows > 0)
            windows.push_back({{"frames", window.frames}, {"residual_rad_s", window.residual_rad_s}, {"windows", window.windows}});
    return {{"along_s", motion.noise.along_s},
            {"across_s", motion.noise.across_s},
            {"largest_acceleration_rad_s2", motion.noise.largest_acceleration_rad_s2},
            {"samples", motion.noise.samples},
            {"level", calibration.cluster.motion_level > 0 ? Json(calibration.cluster.motion_level) : Json()},
            {"level_at_limit", searches.level ? Json(searches.level->at_limit) : Json()},
            {"gated", gated_json(calibration)},
            {"axes_residual_rad_s", calibration.axes_residual_rad_s},
            {"windows", windows}};
}

double resting_s(const Calibration& calibration, Samples samples)
{
    double total_s = 0;
    for (const auto& segment : calibration.rest) total_s += samples[segment.end - 1].time_s - samples[segment.begin].time_s;
    return total_s;
}

}  // namespace

Json calibration_json(const Calibration& calibration, const Searches& searches, Samples samples, const recording::Statistics& statistics)
{
    Json axes = Json::array();
    for (std::size_t axis = 0; axis < calibration.cluster.description.axis_count; ++axis) axes.push_back(axis_json(calibration, axis));
    Json rest = Json::array();
    for (const auto& segment : calibration.rest)
        rest.push_back({{"begin_s", samples[segment.begin].time_s}, {"end_s", samples[segment.end - 1].time_s}});
    Json tau = Json::array();
    Json deviation = Json::array();
    for (const auto& point : calibration.allan) {
        tau.push_back(point.tau_s);
        deviation.push_back(vector_json(point.deviation_rad_s));
    }
    return {{"log", recording::summary(statistics)},
            {"frames", statistics.frames},
            {"rest", rest},
            {"axes", axes},
            {"axes_note", calibration.axes_note.empty() ? Json() : Json(calibration.axes_note)},
            {"outside_class", outside_json(calibration)},
            {"mounting", calibration.motion ? mounting_json(calibration.cluster.description) : Json::array()},
            {"motion_noise", motion_json(calibration, searches)},
            {"replay", replay_json(calibration, searches)},
            {"allan", {{"tau_s", tau}, {"deviation_rad_s", deviation}}}};
}

namespace {

std::string axes_text(const Calibration& calibration)
{
    std::string text =
        "axis instrument  bias deg/s  spread   sigma deg/s  gain-1 %  off nominal deg  walk deg/sqrt(h)  instability deg/h  limit deg/s  "
        "saturated\n";
    const bool rested = !calibration.rest.empty();
    for (std::size_t axis = 0; axis < calibration.cluster.description.axis_count; ++axis) {
        const auto row = static_cast<Eigen::Index>(axis);
        const double limit = calibration.saturation_limit_rad_s[axis];
        text += fmt::format("{:>4} {:<10} {:>11.3f} {:>7} {:>13.3f} {:>9.2f} {:>16.2f} {:>17} {:>18} {:>12} {:>10}\n", axis,
                            axis_name(calibration, axis), calibration.at_rest.bias_rad_s(row) / degree,
                            calibration.rest.size() > 1 ? fmt::format("{:.3f}", calibration.at_rest.bias_spread_rad_s(row) / degree) : "-",
                            calibration.at_rest.deviation_rad_s(row) / degree, 100 * (calibration.cluster.gain[axis] - 1),
                            calibration.misalignment_rad[axis] / degree,
                            rested ? fmt::format("{:.2f}", calibration.allan_figures.random_walk_rad_sqrt_s(row) / degree * 60) : "-",
                            rested ? fmt::format("{:.1f}", calibration.allan_figures.bias_instability_rad_s(row) / degree * 3600) : "-",
                            limit > 0 ? fmt::format("{:.2f}", limit / degree) : "-", calibration.saturated[axis]);
    }
    return text;
}

std::string motion_text(const Calibration& calibration, bool is_silent)
{
    if (!calibration.motion) return fmt::format("\nnominal axes are kept: {}\n", calibration.axes_note);
    const auto& motion = *calibration.motion;
    std::string text = mounting_text(calibration.cluster.description);
    text += fmt::format("\naxes fitted: they disagree by {:.2f} deg/s rms in motion\n", calibration.axes_residual_rad_s / degree);
    if (calibration.cluster.motion_level > 0)
        text += fmt::format("motion noise: {:.2f} times the usual of an array ({})\n", calibration.cluster.motion_level,
                            is_silent ? "so much keeps the accumulating detector silent here"
                                      : "the largest that was tried: accumulating isolates an instrument still");
    if (const auto& gated = calibration.cluster.gated)
        text +=
            fmt::format("gated sums: {:.3f} ms along, {:.3f} ms across, axes {:.1e}, rate {:.1e} (all but the worst frames show so much)\n",
                        gated->jitter_along_s * 1e3, gated->jitter_across_s * 1e3, gated->axes_error, gated->rate_error);
    if (motion.noise.samples == 0) return text + "motion noise: no sample turned violently enough to show it\n";
    text += fmt::format("motion noise: {:.3f} ms x |dw/dt| along it, {:.3f} ms across ({} samples, up to {:.0f} deg/s^2)\n",
                        motion.noise.along_s * 1e3, motion.noise.across_s * 1e3, motion.noise.samples,
                        motion.noise.largest_acceleration_rad_s2 / degree);
    for (const auto& window : motion.windows)
        if (window.windows > 0)
            text += fmt::format("  mean of {:>3} frames: {:.2f} deg/s rms ({} windows)\n", window.frames, window.residual_rad_s / degree,
                                window.windows);
    return text;
}

}  // namespace

std::string calibration_text(const Calibration& calibration, const Searches& searches, Samples samples, const recording::Statistics& statistics)
{
    return fmt::format("{}\n{} resting segments, {:.1f} s\n\n", recording::summary(statistics), calibration.rest.size(),
                       resting_s(calibration, samples)) +
           axes_text(calibration) + outside_text(calibration) + motion_text(calibration, !searches.silence || !searches.silence->at_limit) +
           searches_text(calibration, searches);
}

std::vector<Chart> calibration_charts(const Calibration& calibration)
{
    Chart allan{"Allan deviation at rest", "averaging time, s", "deg/s", true, true, {}};
    const auto& description = calibration.cluster.description;
    for (std::size_t axis = 0; axis < description.axis_count; ++axis) {
        Series series{fmt::format("{} {}", axis, axis_name(calibration, axis)), {}, colour(description.instrument[axis]), true};
        for (const auto& point : calibration.allan)
            series.points.emplace_back(point.tau_s, point.deviation_rad_s(static_cast<Eigen::Index>(axis)) / degree);
        allan.series.push_back(std::move(series));
    }
    if (!calibration.motion || calibration.motion->bins.empty()) return {allan};

    Chart motion{"Disagreement of the axes in motion", "angular acceleration, deg/s^2", "deg/s rms per axis", true, true, {}};
    Series measured{"measured", {}, colour(0), false};
    Series along{"along x |dw/dt|", {}, colour(1), true};
    Series across{"across x |dw/dt|", {}, colour(2), true};
    for (const auto& bin : calibration.motion->bins) {
        const double acceleration = bin.acceleration_rad_s2 / degree;
        measured.points.emplace_back(acceleration, bin.residual_rad_s / degree);
        along.points.emplace_back(acceleration, acceleration * calibration.motion->noise.along_s);
        across.points.emplace_back(acceleration, acceleration * calibration.motion->noise.across_s);
    }
    motion.series = {measured, along, across};
    return {allan, motion};
}

}  // namespace quorient::cli
