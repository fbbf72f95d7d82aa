#include "cli/json_output.hpp"
#include "cli/system_options.hpp"
#include "quorient/attitude/integrator.hpp"
#include "quorient/configuration/document.hpp"
#include "quorient/configuration/reference.hpp"
#include "sources.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <memory>

namespace quorient::cli {

namespace {

using configuration::Problems;

struct CheckOptions {
    SystemOptions system;
    std::string process;
    std::string key;
    bool any_host = false;
    bool reference = false;
    bool json = false;
};

/// What the processes find when they start: what a log holds, and whether the lanes can work on it.
class Trial {
public:
    Trial(const std::string& file, const system::System& system) : system_(system), problems_(file)
    {
        if (auto document = configuration::load_yaml(file)) document_ = std::move(*document);
    }

    Problems run()
    {
        const auto source = sensor::make_source(system_.sensor, 1);
        if (source) try_lanes((*source)->description());
        else report("source.file", source.error());
        return problems_;
    }

private:
    void report(std::string_view path, const std::string& what) { configuration::report(problems_, document_, path, what); }

    void try_lanes(const ClusterDescription& description)
    {
        for (std::size_t i = 0; i < system_.lanes.size(); ++i) {
            const auto monitor = system_.lanes[i].detector.make_monitor(description);
            if (!monitor) report(monitor.error().by_description ? "source" : fmt::format("lanes[{}].detector", i), monitor.error().why);
        }
        const auto cluster = geometry::make_cluster(description);
        for (std::size_t i = 0; cluster && i < system_.integrators().size(); ++i) {
            const auto integrator = attitude::Integrator::make(system_.integrators()[i]->integration, *cluster);
            if (!integrator) report(fmt::format("lanes[{}].integrator", i), integrator.error());
        }
    }

    const system::System& system_;
    Problems problems_;
    YAML::Node document_;
};

Json problems_json(const Problems& problems)
{
    Json list = Json::array();
    for (const auto& problem : problems.all()) {
        Json entry{{"line", nullptr}, {"column", nullptr}, {"key", problem.key}, {"text", problem.text}};
        if (problem.line > 0) {
            entry["line"] = problem.line;
            entry["column"] = problem.column;
        }
        list.push_back(entry);
    }
    return list;
}

void explain(const std::string& key)
{
    const auto text = key == "all" ? configuration::explanation(system::reference(), "The whole file")
                                   : configuration::explanation_of(system::reference(), key);
    if (!text) fail(fmt::format("--key {}: no such key; quorient check --reference lists all", key));
    fmt::print("{}", *text);
}

void check(const CheckOptions& options)
{
    if (options.reference) return fmt::print("{}", system::reference_page());
    if (!options.key.empty()) return explain(options.key);
    if (options.system.file.empty()) fail("quorient check needs a system file, or --reference, or --key");
    auto overrides = options.system.overrides();
    if (!options.process.empty()) overrides.processes = {options.process};
    overrides.any_host = options.any_host;
    const auto judged = system::judge(options.system.file, overrides);
    const Problems problems = judged ? Trial(options.system.file, *judged).run() : judged.error();
    if (options.json)
        fmt::print("{}\n", dump(Json{{"file", options.system.file},
                                     {"problems", problems_json(problems)},
                                     {"configuration", problems.empty() ? Json(judged->configuration) : Json(nullptr)}}));
    if (!problems.empty()) fail(problems.text());
    if (!options.json) fmt::print("{}\n", judged->configuration);
}

}  // namespace

void add_check(Program& program)
{
    auto verb = program.verb("check", "Judge a system file as all processes would, start nothing, print the configuration that holds");
    auto options = std::make_shared<CheckOptions>();
    options->system.add_to(verb, SystemOptions::File::optional);
    verb.option("--process", options->process, "The one process that this host runs: no other network is looked for").value_name("NAME");
    verb.flag("--any-host", options->any_host, "Look for no network: the processes run on other hosts");
    verb.flag("--reference", options->reference, "Print the page that explains every key, in place of checking");
    verb.option("--key", options->key, "Explain one key, one section, or all, in place of checking").value_name("voting.patience");
    verb.flag("--json", options->json, "Problems and configuration as JSON");
    verb.footer(
        "Example:\n  quorient check deploy/configurations/demo.yaml --set "
        "lanes.a.detector.pfa=1.0e-9");
    verb.run([options] { check(*options); });
}

}  // namespace quorient::cli
