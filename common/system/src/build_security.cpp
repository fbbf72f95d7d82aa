#include "build.hpp"
#include "quorient/runtime/clock.hpp"
#include "quorient/security/identity.hpp"
#include "quorient/system/members.hpp"

#include <fmt/format.h>

namespace quorient::system {

namespace {

using bus::SecurityLevel;

constexpr std::int64_t second_ns = 1'000'000'000;

/// Finds the keys of one process, and reports what is wrong with them at its own `security` or at that of the whole file.
class Identities {
public:
    Identities(const System& system, Report& report) : level_(system.monitor.security.level), report_(report) {}

    /// @param identity  whose keys the process joins with
    void find(ProcessSettings& process, const std::string& section, const std::string& identity)
    {
        const auto own = section.empty() ? std::string("security") : section + ".security";
        const auto key = report_.stands(own) ? own : std::string("security");
        const auto level = process.security.level;
        if (level != level_)
            return report_.at(key, fmt::format("{} has level {}, the file {}: they would not discover each other; use one level for all",
                                               process.node.name, bus::to_string(level), bus::to_string(level_)));
        if (level == SecurityLevel::none) return;
        if (process.security.directory.empty())
            return report_.at(key, fmt::format("level {} needs the directory of the keys", bus::to_string(level)));
        take(process, key, identity);
    }

private:
    void take(ProcessSettings& process, const std::string& key, const std::string& name)
    {
        const auto now_s = runtime::SystemClock{}.wall_ns() / second_ns;
        const auto identity = security::find_identity(
            process.security.directory, {name, process.bus.vendor, process.bus.domain, process.security.level}, now_s);
        if (!identity) {
            for (const auto& problem : identity.error()) report_.at(key, problem);
            return;
        }
        process.bus.security = identity->files;
        process.bus.participant = identity->files.common_name;
        process.node.identity_expires_ns = identity->expires_s * second_ns;
    }

    SecurityLevel level_;
    Report& report_;
};

}  // namespace

void build_security(System& system, const Overrides& overrides, Report& report)
{
    if (!overrides.joins || overrides.any_host) return;
    Identities identities(system, report);
    const auto find = [&](ProcessSettings& process, const std::string& section) {
        if (overrides.concerns(process.node.name)) identities.find(process, section, process.node.name);
    };
    find(system.sensor.process, "sensor");
    for (std::size_t i = 0; i < system.lanes.size(); ++i) {
        find(system.lanes[i].detector.process, fmt::format("lanes[{}]", i));
        if (system.has_attitude()) find(system.lanes[i].integrator.process, fmt::format("lanes[{}]", i));
    }
    for (std::size_t i = 0; i < system.voters.size(); ++i) find(system.voters[i].process, fmt::format("voters[{}]", i));
    find(system.monitor, {});
    if (auto& web = system.web_monitor; web && overrides.concerns(web->process.node.name))
        identities.find(web->process, "monitor", web->allow_orders ? operator_name : system.monitor.node.name);
}

}  // namespace quorient::system
