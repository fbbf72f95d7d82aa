#include "composition_options.hpp"

#include "quorient/bus/settings.hpp"

#include <CLI/CLI.hpp>

namespace quorient::composition {

tl::expected<Options, runtime::OptionsError> parse_options(int argc, char** argv)
{
    Options options;
    CLI::App app{"Runs processes of a system file in one process. One that dies takes the others along."};
    app.footer(
        "Example:\n  quorient-run demo.yaml fdi-a attitude-a\n"
        "Exit codes: 0 ended in order, 1 failed while running, 2 bad usage or configuration.");
    app.set_version_flag("--version", runtime::version());
    app.add_option("system", options.system_file, "The system file (YAML)")->required()->type_name("SYSTEM.yaml");
    auto* names = app.add_option("names", options.names, "Processes of the file")->type_name("NAME");
    app.add_option("--of", options.of, "In place of names: the composition of the file (`compose`) that this process is in")
        ->type_name("NAME")
        ->excludes(names);
    std::string vendor;
    app.add_option("--dds", vendor, "DDS vendor in place of the file's: fastdds or cyclonedds");
    app.add_option("--domain", options.domain, "DDS domain in place of the file's");
    app.add_option("--set", options.set, "A value in place of the file's, e.g. source.speed=2 (repeatable)")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    try {
        app.parse(argc, argv);
        if (options.names.empty() && options.of.empty()) throw CLI::RequiredError("NAME, or --of NAME,");
        if (!vendor.empty()) {
            const auto chosen = bus::vendor_from(vendor);
            if (!chosen) throw CLI::ValidationError("--dds", chosen.error());
            options.dds = *chosen;
        }
    } catch (const CLI::ParseError& error) {
        return tl::make_unexpected(runtime::OptionsError{app.exit(error) == 0 ? 0 : 2});
    }
    return options;
}

}  // namespace quorient::composition
