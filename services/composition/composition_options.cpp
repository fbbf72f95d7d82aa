#include "composition_options.hpp"

#include "quorient/runtime/command_line.hpp"

#include <CLI/CLI.hpp>

namespace quorient::composition {

tl::expected<Options, runtime::OptionsError> parse_options(int argc, char** argv)
{
    Options options;
    CLI::App app{"Runs processes of a system file in one process. One that dies takes the others along."};
    app.footer(
        "Example:\n  quorient-run demo.yaml fdi-a attitude-a\n"
        "Exit codes: 0 ended in order, 1 failed while running, 2 bad usage or configuration.");
    runtime::add_system_file(app, options);
    auto* names = app.add_option("names", options.names, "Processes of the file")->type_name("NAME");
    app.add_option("--of", options.of, "In place of names: the composition of the file (`compose`) that this process is in")
        ->type_name("NAME")
        ->excludes(names);
    runtime::add_overrides(app, options);
    app.callback([&options] {
        if (options.names.empty() && options.of.empty()) throw CLI::RequiredError("NAME, or --of NAME,");
    });
    if (const auto read = runtime::parse(app, argc, argv); !read) return tl::make_unexpected(read.error());
    return options;
}

}  // namespace quorient::composition
