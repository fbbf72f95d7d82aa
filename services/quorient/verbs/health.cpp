#include "quorient/runtime/clock.hpp"
#include "quorient/runtime/heartbeat.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <memory>
#include <string>

namespace quorient::cli {

namespace {

struct HealthOptions {
    std::string name;
    double fresh_s = 1;
};

int health(const HealthOptions& options)
{
    const auto beat = runtime::read_heartbeat(options.name);
    if (!beat) {
        fmt::print(stderr, "{}: no heartbeat in {}\n", options.name, runtime::run_directory().string());
        return 1;
    }
    const double age_s = static_cast<double>(runtime::SystemClock{}.steady_ns() - beat->steady_ns) * 1e-9;
    fmt::print("{}: {} frames, the latest {:.3f} s ago\n", options.name, beat->frames, age_s);
    return age_s <= options.fresh_s ? 0 : 1;
}

}  // namespace

void add_health(Program& program)
{
    auto verb = program.verb("health", "Exit 0 if a service of this host handles frames, without joining DDS");
    auto options = std::make_shared<HealthOptions>();
    verb.option("name", options->name, "The process's name in the system file").required();
    verb.option("--fresh", options->fresh_s, "A heartbeat older than this is stale").within(settings::above_zero).value_name("S").shows_default();
    verb.footer("Example:\n  quorient health fdi-a");
    verb.not_as_asked_if("there is no heartbeat, or a stale one");
    verb.run([options] {
        if (const int exit_code = health(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
