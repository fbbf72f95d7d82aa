#include "quorient/bus/settings.hpp"
#include "quorient/runtime/clock.hpp"
#include "quorient/runtime/heartbeat_owner.hpp"
#include "quorient/system/numbers.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace quorient::cli {

namespace {

struct HealthOptions {
    std::string name;
    std::optional<std::uint32_t> domain;
    std::optional<std::uint32_t> unit;
    double fresh_s = 1;
};

std::string described(const runtime::Pulse& pulse)
{
    return fmt::format("{} of '{}', domain {}, unit {}", pulse.service, pulse.owner.system, pulse.owner.domain, pulse.owner.unit);
}

std::string described(const std::vector<runtime::Pulse>& pulses)
{
    std::vector<std::string> all;
    for (const auto& pulse : pulses) all.push_back(described(pulse));
    return fmt::format("{}", fmt::join(all, "; "));
}

/// What there is in place of the one asked for: its namesakes, else the names of all.
std::string others(const std::vector<runtime::Pulse>& all, const std::string& name)
{
    if (all.empty()) return "there is none at all (another QUORIENT_RUN_DIR?)";
    auto namesakes = all;
    std::erase_if(namesakes, [&](const runtime::Pulse& pulse) { return pulse.service != name; });
    if (!namesakes.empty()) return "there is " + described(namesakes);
    std::set<std::string> names;
    for (const auto& pulse : all) names.insert(pulse.service);
    return fmt::format("there are those of {}", fmt::join(names, ", "));
}

/// @throws Exit where there is none, or more than one: an answer for another system's process would be worse than none.
runtime::Pulse only_one(const HealthOptions& options)
{
    const auto all = runtime::read_pulses();
    auto asked_for = all;
    std::erase_if(asked_for, [&](const runtime::Pulse& pulse) {
        return pulse.service != options.name || (options.domain && pulse.owner.domain != *options.domain) ||
               (options.unit && pulse.owner.unit != *options.unit);
    });
    if (asked_for.size() > 1)
        fail(
            fmt::format("{}: several processes have this name: {}. Choose one by --domain and --unit", options.name, described(asked_for)));
    if (asked_for.size() == 1) return asked_for.front();
    const auto asked = fmt::format("{}{}{}", options.name, options.domain ? fmt::format(" in domain {}", *options.domain) : "",
                                   options.unit ? fmt::format(" of unit {}", *options.unit) : "");
    fmt::print(stderr, "{}: no heartbeat in {}; {}\n", asked, runtime::run_directory().string(), others(all, options.name));
    throw Exit{ExitCode::not_as_asked};
}

int health(const HealthOptions& options)
{
    const auto pulse = only_one(options);
    const auto& beat = pulse.beat;
    if (beat.frames == 0) {
        fmt::print("{}: has handled no frame yet\n", described(pulse));
        return ExitCode::not_as_asked;
    }
    const double age_s = static_cast<double>(runtime::SystemClock{}.steady_ns() - beat.steady_ns) * 1e-9;
    fmt::print("{}: {} frames, the latest {:.3f} s ago\n", described(pulse), beat.frames, age_s);
    return age_s <= options.fresh_s ? ExitCode::done : ExitCode::not_as_asked;
}

}  // namespace

void add_health(Program& program)
{
    auto verb = program.verb("health", "Exit 0 if a service of this host handles frames, without joining DDS");
    auto options = std::make_shared<HealthOptions>();
    verb.option("name", options->name, "The process's name in the system file").required();
    verb.option("--domain", options->domain, "Its DDS domain, where several systems of this host have such a process")
        .within(bus::bus_record(), "domain");
    verb.option("--unit", options->unit, "Its unit, likewise").within(system::unit_ids);
    verb.option("--fresh", options->fresh_s, "A heartbeat older than this is stale").within(settings::above_zero).value_name("S").shows_default();
    verb.footer("Example:\n  quorient health fdi-a");
    verb.not_as_asked_if("there is no heartbeat, a stale one, or no frame yet");
    verb.run([options] {
        if (const int exit_code = health(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
