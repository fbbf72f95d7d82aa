#include "build.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <string>

namespace quorient::system {

namespace {

constexpr std::size_t longest_process_name = std::tuple_size_v<decltype(ServiceStatus::name)> - 1;
constexpr std::size_t longest_unit_name = std::tuple_size_v<decltype(ClusterDescription::name)> - 1;
constexpr std::size_t longest_instrument_name = std::tuple_size_v<decltype(ClusterDescription::instrument_name)::value_type> - 1;

/// What a name of a process may not be: heartbeats and logs are files of that name.
std::string unfit_for_files(const std::string& name)
{
    if (name.find('/') != std::string::npos) return "must not hold '/': files are named after it";
    if (name.starts_with('.')) return "must not begin with '.': files are named after it";
    if (std::ranges::any_of(name, [](unsigned char letter) { return std::iscntrl(letter) != 0; }))
        return "must not hold control characters";
    return {};
}

/// Names that must differ, and what each was used for first.
class Names {
public:
    explicit Names(Report& report) : report_(report) {}

    void reserve(const std::string& name, const std::string& what) { taken_.emplace(name, what); }

    /// @param what  that is called so, for others that want the name
    void take(const std::string& path, const std::string& name, const std::string& what)
    {
        const auto [earlier, is_new] = taken_.emplace(name, what);
        if (!is_new) report_.at(path, fmt::format("'{}' is taken by {}", name, earlier->second));
    }

private:
    Report& report_;
    std::map<std::string, std::string> taken_;
};

void check_length(Report& report, const std::string& path, const std::string& name, std::size_t longest)
{
    if (name.size() > longest) report.at(path, fmt::format("'{}' has more than {} characters", name, longest));
}

void check_processes(const File& file, Report& report)
{
    Names names(report);
    names.reserve("sensor", "the process that publishes frames");
    names.reserve("monitor", "programs that look on");
    names.reserve("operator", "the verbs that give orders, whose keys have this name");
    names.reserve("roudi", "iceoryx's daemon, whose log has this name");
    Names lanes(report);
    const bool attitude = unit_kind(file.unit.kind).gives_attitude;
    for (std::size_t i = 0; i < file.lanes.size(); ++i) {
        const auto& name = file.lanes[i].name;
        const auto path = fmt::format("lanes[{}].name", i);
        lanes.take(path, name, fmt::format("lanes[{}]", i));
        if (const auto unfit = unfit_for_files(name); !unfit.empty()) report.at(path, unfit);
        check_length(report, path, name, longest_process_name - std::string_view{"attitude-"}.size());
        names.reserve("fdi-" + name, fmt::format("the detector of lanes[{}]", i));
        if (attitude) names.reserve("attitude-" + name, fmt::format("the integrator of lanes[{}]", i));
    }
    for (std::size_t i = 0; i < file.voters.size(); ++i) {
        const auto& name = file.voters[i].name;
        const auto path = fmt::format("voters[{}].name", i);
        names.take(path, name, fmt::format("voters[{}]", i));
        if (const auto unfit = unfit_for_files(name); !unfit.empty()) report.at(path, unfit);
        check_length(report, path, name, longest_process_name);
    }
    if (!file.monitor || file.monitor->name == MonitorSection{}.name) return;
    names.take("monitor.name", file.monitor->name, "the monitor");
    if (const auto unfit = unfit_for_files(file.monitor->name); !unfit.empty()) report.at("monitor.name", unfit);
    check_length(report, "monitor.name", file.monitor->name, longest_process_name);
}

}  // namespace

void check_names(const File& file, Report& report)
{
    check_processes(file, report);
    check_length(report, "unit.name", *file.unit.name, longest_unit_name);
    Names imus(report);
    for (std::size_t i = 0; i < file.source.imus.size(); ++i) {
        const auto path = fmt::format("source.imus[{}].name", i);
        imus.take(path, file.source.imus[i].name, fmt::format("source.imus[{}]", i));
        check_length(report, path, file.source.imus[i].name, longest_instrument_name);
    }
    Names channels(report);
    if (!file.unit.channels) return;
    for (std::size_t i = 0; i < file.unit.channels->size(); ++i) {
        const auto path = fmt::format("unit.channels[{}]", i);
        channels.take(path, file.unit.channels->at(i), fmt::format("channel {}", i));
        check_length(report, path, file.unit.channels->at(i), longest_instrument_name);
    }
}

}  // namespace quorient::system
