#include "build.hpp"
#include "quorient/attitude/update.hpp"
#include "quorient/fdi/methods.hpp"
#include "quorient/fdi/observer_detector.hpp"

#include <fmt/format.h>

namespace quorient::system {

namespace {

/// Where the axes are not known before the log is opened, nothing is said here.
tl::expected<void, std::string> try_detector(const System& system, const DetectorProcess& detector)
{
    if (detector.observers) {
        const auto observers = fdi::ObserverDetector::make(*detector.observers, system.interval_s, detector.observer_margin);
        if (!observers) return tl::unexpected(observers.error());
        return {};
    }
    if (!system.sensor.cluster) return {};
    const auto made = fdi::make_detector(detector.detection, *system.sensor.cluster);
    if (!made) return tl::unexpected(made.error());
    return {};
}

void check_detector(const System& system, const DetectorProcess& detector, const std::string& path, Report& report)
{
    if (const auto verdict = fdi::check(detector.verdict); !verdict) report.at(path + ".confirm_required", verdict.error());
    if (detector.observers && (!system.vessel || detector.observers->poles.empty())) return;  // reported already
    if (const auto possible = try_detector(system, detector); !possible) report.at(path, possible.error());
}

void check_integrator(const System& system, const IntegratorProcess& integrator, const std::string& path, Report& report)
{
    if (const auto update = attitude::make_update(integrator.integration.algorithm); !update)
        report.at(path + ".algorithm", update.error());
    if (const double longest_s = attitude::longest_history_s(system.interval_s); integrator.integration.history_s > longest_s)
        report.at(path + ".history_s",
                  fmt::format("must be at most {} [s] at this rate, got {}", longest_s, integrator.integration.history_s));
}

}  // namespace

void check_algorithms(const System& system, Report& report)
{
    for (std::size_t i = 0; i < system.lanes.size(); ++i) {
        check_detector(system, system.lanes[i].detector, fmt::format("lanes[{}].detector", i), report);
        if (system.has_attitude()) check_integrator(system, system.lanes[i].integrator, fmt::format("lanes[{}].integrator", i), report);
    }
    for (const auto& voter : system.voters)
        if (const auto possible = voting::check(voter.voting); !possible && !system.lanes.empty()) report.at("voting", possible.error());
}

}  // namespace quorient::system
