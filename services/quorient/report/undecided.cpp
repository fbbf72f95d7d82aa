#include "undecided.hpp"

#include "cli/json_output.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>

namespace quorient::report {

namespace {

using Spell = evaluation::UndecidedSpells::Spell;

double length_s(const Spell& spell)
{
    return spell.to_s - spell.from_s;
}

}  // namespace

std::string undecided_text(const evaluation::RunObserver& run)
{
    std::string text;
    for (const auto& lane : run.lanes())
        for (const auto& [state, total_s] : lane.undecided.total_s()) {
            const Spell* longest = nullptr;
            std::size_t count = 0;
            for (const Spell& spell : lane.undecided.spells()) {
                if (spell.state != state) continue;
                ++count;
                if (longest == nullptr || length_s(spell) > length_s(*longest)) longest = &spell;
            }
            text += fmt::format("lane {:<4}{} for {:.3f} s", lane.name, to_string(state), total_s);
            if (longest != nullptr)
                text += fmt::format(" in {} spell{}, {}from {:.3f} s to {:.3f} s{}", count, count == 1 ? "" : "s",
                                    count == 1 ? "" : "the longest ", longest->from_s, longest->to_s,
                                    longest->axes == 0 ? std::string{} : fmt::format(" ({})", run.names_of(longest->axes)));
            text += '\n';
        }
    return text;
}

nlohmann::ordered_json undecided_s_json(const evaluation::RunObserver& run)
{
    auto by_lane = nlohmann::ordered_json::object();
    for (const auto& lane : run.lanes()) {
        auto& entry = by_lane[lane.name] = nlohmann::ordered_json::object();
        for (const auto& [state, total_s] : lane.undecided.total_s()) entry[std::string(to_string(state))] = total_s;
    }
    return by_lane;
}

nlohmann::ordered_json undecided_json(const evaluation::RunObserver& run)
{
    auto list = nlohmann::ordered_json::array();
    for (const auto& lane : run.lanes())
        for (const Spell& spell : lane.undecided.spells())
            list.push_back({{"lane", lane.name},
                            {"state", to_string(spell.state)},
                            {"axes", cli::axes_json(spell.axes)},
                            {"names", run.names_of(spell.axes)},
                            {"from_s", spell.from_s},
                            {"to_s", spell.to_s}});
    return list;
}

}  // namespace quorient::report
