#include "system_options.hpp"

#include "quorient/runtime/clock.hpp"
#include "quorient/security/identity.hpp"
#include "quorient/system/numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <filesystem>

namespace quorient::cli {

namespace {

constexpr std::uint32_t usual_domain = 42;

security::Governance governance_of(const std::string& directory)
{
    const auto governance = security::find_governance(directory);
    if (!governance) fail(governance.error());
    return *governance;
}

void secure(bus::Settings& settings, const std::string& directory, const std::string& name)
{
    const auto governance = governance_of(directory);
    const std::int64_t now_s = runtime::SystemClock{}.wall_ns() / 1'000'000'000;
    const auto identity = security::find_identity(directory, {name, settings.vendor, settings.domain, governance.level}, now_s);
    if (!identity) fail(fmt::format("{}", fmt::join(identity.error(), "\n")));
    settings.security = identity->files;
    settings.participant = identity->files.common_name;
}

}  // namespace

void BusOptions::add_to(Verb& verb, const std::string& role)
{
    identity = role;
    verb.option("--dds", dds, "fastdds or cyclonedds").shows_default();
    verb.option("--domain", domain, fmt::format("DDS domain; default: that of --keys, else {}", usual_domain)).within(bus::bus_record(), "domain");
    verb.option("--interface", interface, "Network interface by name, address or subnet; any = the vendor's choice").shows_default();
    verb.option("--peer", peers, "IPv4 address to look for peers at, in place of multicast (repeatable)").value_name("ADDRESS");
    verb.option("--participants-per-host", participants_per_host, "That an address of --peer may have")
        .within(bus::bus_record(), "participants_per_host")
        .shows_default();
    verb.option("--unit", unit, "Unit id").within(system::unit_ids).shows_default();
    verb.option("--keys", keys, "Directory of the keys of a secured system (quorient keys)").value_name("DIR");
    verb.option("--as", identity, "Identity to use from that directory").value_name("NAME").shows_default();
}

std::uint32_t BusOptions::joined_domain() const
{
    if (domain) return *domain;
    return keys.empty() ? usual_domain : governance_of(keys).domain;
}

std::unique_ptr<bus::Bus> BusOptions::open(const std::string& participant) const
{
    const auto vendor = bus::vendor_from(dds);
    if (!vendor) {
        fmt::print(stderr, "--dds: {}\n", vendor.error());
        throw Exit{2};
    }
    bus::Settings settings;
    settings.vendor = *vendor;
    settings.domain = joined_domain();
    settings.interface = interface == "any" ? "" : interface;
    settings.peers = peers;
    settings.participants_per_host = participants_per_host;
    settings.participant = participant;
    settings.voted_lease_s = voted_lease_s;
    if (!keys.empty()) secure(settings, keys, identity);
    auto opened = bus::open(settings);
    if (!opened) {
        fmt::print(stderr, "{}\n", opened.error());
        throw Exit{2};
    }
    return std::move(*opened);
}

void SystemOptions::add_to(Verb& verb, File file_is)
{
    const auto positional = verb.option("system", file, "The system file (YAML)").value_name("SYSTEM.yaml");
    if (file_is == File::required) positional.required();
    verb.option("--dds", dds, "DDS vendor of every process in place of the file's: fastdds or cyclonedds");
    verb.option("--domain", domain, "DDS domain in place of the file's").within(bus::bus_record(), "domain");
    verb.option("--set", set,
                "A value in place of the file's, e.g. source.duration_s=5; a file's name counts from the system file's folder (repeatable)")
        .value_name("KEY=VALUE");
    verb.option("--log", log, "The recording in place of the file's");
    verb.option("--speed", speed, "Times real time").within(settings::above_zero);
    verb.option("--fault", faults, "One more fault, e.g. axis=1,kind=scale,value=0.8,start=8,end=18 (repeatable)");
}

void SystemOptions::add_replay_to(Verb& verb)
{
    verb.option("--system", file, "The system file (YAML); its source gives way to the log").required().value_name("FILE");
    verb.option("--set", set, "A value in place of the file's; a file's name counts from the system file's folder (repeatable)")
        .value_name("KEY=VALUE");
    verb.option("--fault", faults, "One more fault, e.g. axis=7,kind=bias,value=1,start=14 (repeatable)");
}

std::vector<std::string> SystemOptions::assignments() const
{
    auto result = set;
    if (!log.empty()) result.push_back(fmt::format("source.file={}", std::filesystem::absolute(log).string()));
    if (speed) result.push_back(fmt::format("source.speed={}", *speed));
    for (const auto& fault : faults) result.push_back(fmt::format("source.faults+='{}'", fault));
    return result;
}

system::Overrides SystemOptions::overrides(bool joins) const
{
    system::Overrides overrides{.domain = domain, .set = assignments(), .joins = joins};
    if (!dds.empty()) {
        const auto vendor = bus::vendor_from(dds);
        if (!vendor) {
            fmt::print(stderr, "--dds: {}\n", vendor.error());
            throw Exit{2};
        }
        overrides.dds = *vendor;
    }
    return overrides;
}

system::System SystemOptions::load() const
{
    return load(true);
}

system::System SystemOptions::load_without_joining() const
{
    return load(false);
}

system::System SystemOptions::load(bool joins) const
{
    auto asked = overrides(joins);
    asked.any_host = asked.any_host || !joins;
    auto loaded = system::load(file, asked);
    if (!loaded) {
        fmt::print(stderr, "{}\n", loaded.error());
        throw Exit{2};
    }
    return std::move(*loaded);
}

}  // namespace quorient::cli
