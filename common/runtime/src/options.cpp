#include "quorient/runtime/options.hpp"

#include "quorient/bus/settings.hpp"
#include "quorient/runtime/command_line.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace quorient::runtime {

void add_system_file(CLI::App& app, SystemChoice& choice)
{
    app.set_version_flag("--version", version());
    app.add_option("system", choice.system_file, "The system file (YAML)")->required()->type_name("SYSTEM.yaml");
}

void add_overrides(CLI::App& app, SystemChoice& choice)
{
    const auto choose = [&choice](const std::string& vendor) {
        if (vendor.empty()) return;
        const auto chosen = bus::vendor_from(vendor);
        if (!chosen) throw CLI::ValidationError("--dds", chosen.error());
        choice.dds = *chosen;
    };
    app.add_option_function<std::string>("--dds", choose, "DDS vendor in place of the file's: fastdds or cyclonedds");
    app.add_option("--domain", choice.domain, "DDS domain in place of the file's");
    app.add_option("--set", choice.set, "A value in place of the file's, e.g. source.speed=2 (repeatable)")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
}

tl::expected<void, OptionsError> parse(CLI::App& app, int argc, char** argv)
{
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return tl::make_unexpected(OptionsError{app.exit(error) == 0 ? 0 : 2});
    }
    return {};
}

tl::expected<Options, OptionsError> parse_options(int argc, char** argv, const std::string& description, const std::string& default_name,
                                                  const std::vector<Switch>& switches)
{
    Options options;
    options.name = default_name;
    CLI::App app{description};
    const std::string program = argc > 0 ? std::string{argv[0]}.substr(std::string{argv[0]}.find_last_of('/') + 1) : "service";
    app.footer(
        fmt::format("Example:\n  {} demo.yaml{}\nExit codes: 0 ended in order, 1 failed while running, 2 bad usage or configuration.",
                    program, default_name.empty() ? " --name a-name-of-the-file" : ""));
    add_system_file(app, options);
    auto* name = app.add_option("--name", options.name, "This process's name in the system file");
    if (default_name.empty()) name->required();
    else name->capture_default_str();
    add_overrides(app, options);
    for (const auto& one : switches) {
        app.add_flag_callback(one.name, [&options, &one] { options.set.push_back(one.assignment); }, one.help);
    }
    if (const auto read = parse(app, argc, argv); !read) return tl::make_unexpected(read.error());
    return options;
}

std::string version()
{
    return QUORIENT_VERSION;
}

}  // namespace quorient::runtime
