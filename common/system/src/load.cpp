#include "build.hpp"
#include "quorient/configuration/document.hpp"
#include "quorient/configuration/table.hpp"
#include "quorient/system/system.hpp"
#include "sections/file.hpp"

#include <fmt/format.h>

namespace quorient::system {

namespace {

using configuration::Problems;

/// The values of the command line, into the document.
void assign(YAML::Node& document, const std::vector<std::string>& assignments, Problems& problems)
{
    for (const auto& assignment : assignments) {
        if (const auto path = configuration::assign(document, assignment)) problems.replaced(*path, "--set " + assignment);
        else problems.add("--set " + path.error());
    }
}

void override(const Overrides& overrides, ProcessSettings& process)
{
    if (overrides.dds) {
        process.bus.vendor = *overrides.dds;
        // The other vendor's shared memory does not come along.
        if (process.bus.transport == Transport::shared_memory || process.bus.transport == Transport::iceoryx)
            process.bus.transport = Transport::udp;
    }
    if (overrides.domain) process.bus.domain = *overrides.domain;
}

void override(const Overrides& overrides, File& file)
{
    for_each_process(file, [&](const std::string&, ProcessSettings& process) { override(overrides, process); });
}

}  // namespace

tl::expected<System, Problems> judge(const std::string& name, const Overrides& overrides)
{
    auto document = configuration::load_yaml(name);
    if (!document) return tl::unexpected(document.error());
    Problems problems{name};
    assign(*document, overrides.set, problems);

    File file;
    configuration::Section root{*document, "", problems};
    file_table().read(root, file);
    override(overrides, file);

    Report report{*document, problems};
    System system = build(name, file, overrides, report);
    if (!problems.empty()) return tl::unexpected(problems);
    system.configuration = configuration::to_text(file_table().write(file));
    return system;
}

tl::expected<System, std::string> load(const std::string& file, const Overrides& overrides)
{
    auto judged = judge(file, overrides);
    if (!judged) return tl::unexpected(judged.error().text());
    return std::move(*judged);
}

}  // namespace quorient::system
