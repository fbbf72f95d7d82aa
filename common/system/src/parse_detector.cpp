#include "parse_detector.hpp"

#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/fdi/methods.hpp"
#include "quorient/fdi/observer_detector.hpp"
#include "quorient/system/plant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

namespace quorient::system {

using runtime::Section;

namespace {

void parse_verdict(Section& section, fdi::VerdictSettings& verdict)
{
    section.whole("confirm_required", verdict.confirm_required, 1, 32);
    section.whole("confirm_window", verdict.confirm_window, 1, 32);
    section.whole("warm_up_frames", verdict.warm_up_frames, 0, 100'000);
    section.whole("onset_guard_frames", verdict.onset_guard_frames, 0, 1000);
    section.number("readmit_after_s", verdict.readmit_after_s, runtime::above_zero);
    if (verdict.confirm_required > verdict.confirm_window) section.problem("confirm_required", "cannot be more than confirm_window");
}

/// What the calibration of the log tells of its motion noise.
void take_calibration(const calibration::CalibratedCluster& cluster, fdi::DetectorSettings& detection)
{
    if (cluster.motion_level > 0) detection.motion_noise = cluster.motion_level;
    detection.gated_noise = cluster.gated;
}

void parse_detection(Section section, const System& system, DetectorProcess& detector)
{
    auto& detection = detector.detection;
    section.text("method", detection.method);
    section.number("tolerance", detection.tolerance, runtime::above_zero);
    section.number("sigma", detection.sigma, runtime::above_zero);
    section.number("pfa", detection.pfa, runtime::probability);
    section.number("bound", detection.bound, runtime::above_zero);
    section.number("threshold", detection.threshold, runtime::above_zero);
    section.whole("max_faults", detection.max_faults);
    section.number("margin", detection.margin, runtime::not_negative);
    section.number("doubt", detection.doubt, {.lowest = 0, .highest = 1});
    if (const auto& log = system.sensor.source.log; log && log->calibration) take_calibration(*log->calibration, detection);
    section.number("motion_noise", detection.motion_noise, runtime::above_zero);
    section.boolean("instruments", detection.instruments);
    section.boolean("relaxed", detection.relaxed);
    section.boolean("bare", detection.bare);
    parse_verdict(section, detector.verdict);
    if (!fdi::find_method(detection.method)) {
        std::vector<std::string_view> names;
        for (const auto& entry : fdi::methods()) names.push_back(entry.word);
        section.problem("method", fmt::format("unknown method '{}'; known are {}", detection.method, fmt::join(names, ", ")));
    }
    section.finish();
}

void parse_observers(Section section, const System& system, DetectorProcess& detector)
{
    if (section.has("method")) section.problem("method", "a vessel's detectors are observers; choose by scheme: directional or blind");
    auto& observers = detector.observers.emplace();
    if (system.vessel) observers.plant = {system.vessel->a, system.vessel->b, system.vessel->c};
    std::string scheme{fdi::to_string(observers.scheme)};
    section.text("scheme", scheme);
    if (const auto parsed = fdi::parse_observer_scheme(scheme)) observers.scheme = *parsed;
    else section.problem("scheme", parsed.error());
    section.require("poles");
    parse_poles(section, "poles", observers.poles);
    section.numbers("sigma", observers.sigma, runtime::not_negative);
    section.number("model_error", observers.model_error, {.lowest = 0, .highest = 1});
    section.number("pfa", observers.false_alarm_probability, runtime::probability);
    section.number("threshold", observers.threshold, runtime::above_zero);
    section.number("least_contrast", observers.least_contrast, {.lowest = 1});
    section.number("margin", detector.observer_margin, {.lowest = 1});
    parse_verdict(section, detector.verdict);
    if (observers.sigma.empty() && !observers.threshold && system.sensor.source.vessel->noise > 0)
        observers.sigma = {system.sensor.source.vessel->noise};
    section.finish();
}

/// What of these settings cannot be.
tl::expected<void, std::string> try_detector(const System& system, const DetectorProcess& detector)
{
    if (detector.observers) {
        auto observers = fdi::ObserverDetector::make(*detector.observers, system.interval_s, detector.observer_margin);
        if (!observers) return tl::make_unexpected(observers.error());
        return {};
    }
    if (!system.sensor.cluster) return {};
    const auto made = fdi::make_detector(detector.detection, *system.sensor.cluster);
    if (!made) return tl::make_unexpected(made.error());
    return {};
}

}  // namespace

void parse_detector(Section& lane, const System& system, DetectorProcess& detector)
{
    if (!system.has_attitude()) parse_observers(lane.section("detector"), system, detector);
    else parse_detection(lane.section("detector"), system, detector);
    if (detector.observers && (!system.vessel || detector.observers->poles.empty())) return;  // told already
    if (const auto possible = try_detector(system, detector); !possible) lane.problem("detector", possible.error());
}

}  // namespace quorient::system
