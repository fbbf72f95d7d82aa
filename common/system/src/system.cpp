#include "quorient/system/system.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace quorient::system {

namespace {

template <class Entries, class Process>
auto find(const System& system, const Entries& entries, std::string_view wanted, Process process_of)
    -> tl::expected<std::decay_t<decltype(process_of(entries.front()))>, std::string>
{
    std::vector<std::string> names;
    for (const auto& entry : entries) {
        const auto& process = process_of(entry);
        if (process.process.node.name == wanted) return process;
        names.push_back(process.process.node.name);
    }
    return tl::make_unexpected(fmt::format("{}: no process '{}' of this kind; there are {}", system.file, wanted, fmt::join(names, ", ")));
}

}  // namespace

tl::expected<DetectorProcess, std::string> System::detector(std::string_view process) const
{
    return find(*this, lanes, process, [](const LaneProcess& lane) -> const DetectorProcess& { return lane.detector; });
}

tl::expected<IntegratorProcess, std::string> System::integrator(std::string_view process) const
{
    if (!has_attitude()) return tl::make_unexpected(fmt::format("{}: a vessel's rates give no attitude: there are no integrators", file));
    return find(*this, lanes, process, [](const LaneProcess& lane) -> const IntegratorProcess& { return lane.integrator; });
}

tl::expected<VoterProcess, std::string> System::voter(std::string_view process) const
{
    return find(*this, voters, process, [](const VoterProcess& voter) -> const VoterProcess& { return voter; });
}

}  // namespace quorient::system
