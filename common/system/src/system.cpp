#include "quorient/system/system.hpp"

#include "quorient/fdi/observer_detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

namespace quorient::system {

namespace {

template <class Entries, class Process>
auto find(const System& system, const Entries& entries, std::string_view wanted, Process process_of)
    -> tl::expected<std::decay_t<decltype(process_of(entries.front()))>, std::string>
{
    std::vector<std::string> names;
    for (const auto& entry : entries) {
        const auto& process = process_of(entry);
        if (process.process.node.name == wanted) return process;
        names.push_back(process.process.node.name);
    }
    return tl::make_unexpected(fmt::format("{}: no process '{}' of this kind; there are {}", system.file, wanted, fmt::join(names, ", ")));
}

}  // namespace

tl::expected<fdi::FaultMonitor, Unfit> DetectorProcess::make_monitor(const ClusterDescription& description) const
{
    const auto unfit = [](const std::string& why) { return tl::unexpected(Unfit{why}); };
    if (!observers) {
        const auto cluster = geometry::make_cluster(description);
        if (!cluster) return tl::unexpected(Unfit{cluster.error(), true});
        auto made = fdi::FaultMonitor::make(detection, verdict, *cluster);
        if (!made) return unfit(made.error());
        return std::move(*made);
    }
    const auto channels = static_cast<std::size_t>(observers->plant.outputs());
    if (description.axis_count != channels)
        return unfit(fmt::format("the description has {} channels, the plant of the system file {}", description.axis_count, channels));
    auto bank = fdi::ObserverDetector::make(*observers, description.interval_s, observer_margin);
    if (!bank) return unfit(bank.error());
    auto made = fdi::FaultMonitor::make(std::move(*bank), verdict, channels);
    if (!made) return unfit(made.error());
    return std::move(*made);
}

std::vector<const IntegratorProcess*> System::integrators() const
{
    std::vector<const IntegratorProcess*> all;
    for (const auto& lane : lanes)
        if (has_attitude()) all.push_back(&lane.integrator);
    return all;
}

std::vector<const ProcessSettings*> System::processes() const
{
    std::vector<const ProcessSettings*> all;
    for (const auto& voter : voters) all.push_back(&voter.process);
    for (const auto* one : integrators()) all.push_back(&one->process);
    for (const auto& lane : lanes) all.push_back(&lane.detector.process);
    if (web_monitor) all.push_back(&web_monitor->process);
    all.push_back(&sensor.process);
    return all;
}

const ProcessSettings* System::process(std::string_view wanted) const
{
    for (const auto* one : processes())
        if (one->node.name == wanted) return one;
    return nullptr;
}

bool Overrides::concerns(std::string_view process) const
{
    return processes.empty() || std::ranges::find(processes, process) != processes.end();
}

tl::expected<DetectorProcess, std::string> System::detector(std::string_view process) const
{
    return find(*this, lanes, process, [](const LaneProcess& lane) -> const DetectorProcess& { return lane.detector; });
}

tl::expected<IntegratorProcess, std::string> System::integrator(std::string_view process) const
{
    if (!has_attitude())
        return tl::make_unexpected(fmt::format("{}: {} give no attitude: there are no integrators", file, unit_kind(sensor.kind).subject));
    return find(*this, lanes, process, [](const LaneProcess& lane) -> const IntegratorProcess& { return lane.integrator; });
}

tl::expected<VoterProcess, std::string> System::voter(std::string_view process) const
{
    return find(*this, voters, process, [](const VoterProcess& voter) -> const VoterProcess& { return voter; });
}

}  // namespace quorient::system
