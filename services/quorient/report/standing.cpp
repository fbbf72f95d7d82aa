#include "standing.hpp"

#include "cli/json_output.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>

namespace quorient::report {

namespace {

/// The verdict that the output rests on: the primary lane's; without voters, the one that leaves out most.
const FaultVerdict* decisive(const Standing& standing)
{
    if (standing.voted) {
        const auto primary = standing.verdicts.find(standing.voted->primary_lane);
        return primary != standing.verdicts.end() ? &primary->second : nullptr;
    }
    const auto worst = std::ranges::max_element(standing.verdicts, {}, [](const auto& entry) { return std::popcount(entry.second.isolated_mask); });
    return worst != standing.verdicts.end() ? &worst->second : nullptr;
}

AxisMask out_of(const Standing& standing)
{
    const auto* verdict = decisive(standing);
    return standing.voted ? standing.voted->isolated_mask : verdict ? verdict->isolated_mask : 0;
}

std::string known_name(const std::map<std::uint32_t, std::string>& names, const char* what, std::uint32_t number)
{
    const auto found = names.find(number);
    return found != names.end() ? found->second : fmt::format("{} {}", what, number);
}

/// How long an axis has been excluded, at the frame that its exclusion comes with.
std::optional<double> excluded_for_s(const Standing& standing, std::size_t axis)
{
    const auto* verdict = decisive(standing);
    if (!verdict || !standing.description || verdict->excluded_from[axis] > verdict->sequence) return std::nullopt;
    return static_cast<double>(verdict->sequence - verdict->excluded_from[axis]) * standing.description->interval_s;
}

std::string axis_text(const Standing& standing, std::size_t axis)
{
    const auto name = standing.description ? axis_name(*standing.description, axis) : axis_numbers(axis_bit(axis));
    const auto age_s = excluded_for_s(standing, axis);
    return age_s ? fmt::format("{} since {:.1f} s", name, *age_s) : name;
}

std::string out_text(const Standing& standing)
{
    std::string text;
    for (std::size_t axis = 0; axis < max_axes; ++axis)
        if (has_axis(out_of(standing), axis)) text += (text.empty() ? "out: " : ", ") + axis_text(standing, axis);
    return text.empty() ? "no axis is out" : text;
}

std::string redundancy_text(const Standing& standing)
{
    const auto* verdict = decisive(standing);
    if (!verdict || !standing.description) return "no verdict yet";
    const int left = standing.description->axis_count - std::popcount(out_of(standing));
    const unsigned detectable = verdict->detectable_remaining;
    return fmt::format("{} axes left, {} further fault{} can be detected", left, detectable == 0 ? "no" : std::to_string(detectable),
                       detectable == 1 || detectable == 0 ? "" : "s");
}

std::string attitude_text(const Standing& standing, std::int64_t now_ns)
{
    const auto& voted = *standing.voted;
    const auto level = level_of(voted);
    const char* verdict = is_vouched(voted) ? "GOOD" : level == VoteLevel::single ? "DOUBTFUL" : "BAD";
    const auto since =
        standing.level_since_ns ? fmt::format(" since {:.0f} s", static_cast<double>(now_ns - *standing.level_since_ns) * 1e-9) : std::string{};
    const int vouching = std::popcount(voted.vouching_mask);
    return fmt::format("{}: attitude {}{}, from {}, primary lane {}, {} lane{} vouch{}", verdict, to_string(level), since,
                       known_name(standing.voters, "voter", voted.voter), known_name(standing.lanes, "lane", voted.primary_lane), vouching,
                       vouching == 1 ? "" : "s", vouching == 1 ? "es" : "");
}

}  // namespace

std::string standing_text(const Standing& standing, std::int64_t now_ns)
{
    if (!standing.voted && !standing.voters.empty() && !standing.output_is_due)
        return "NOTHING YET: voters run, and their output has not been received so far; listen for longer";
    if (!standing.voted && standing.verdicts.empty()) return "NOTHING: no voter and no detector sends anything";
    const auto head = standing.voted              ? attitude_text(standing, now_ns)
                      : !standing.voters.empty() ? std::string("BAD: no voter owns the output")
                                                 : fmt::format("detectors only: {}", to_string(state_of(*decisive(standing))));
    return fmt::format("{}; {}; {}", head, out_text(standing), redundancy_text(standing));
}

nlohmann::ordered_json standing_json(const Standing& standing, std::int64_t now_ns)
{
    nlohmann::ordered_json json{{"text", standing_text(standing, now_ns)}, {"good", nullptr}, {"level", nullptr}, {"level_since_s", nullptr},
                                {"owner", nullptr}, {"primary_lane", nullptr}, {"detectable_remaining", nullptr}};
    if (standing.voted) {
        json["good"] = is_vouched(*standing.voted);
        json["level"] = to_string(level_of(*standing.voted));
        json["owner"] = known_name(standing.voters, "voter", standing.voted->voter);
        json["primary_lane"] = known_name(standing.lanes, "lane", standing.voted->primary_lane);
    }
    if (standing.level_since_ns) json["level_since_s"] = static_cast<double>(now_ns - *standing.level_since_ns) * 1e-9;
    if (const auto* verdict = decisive(standing)) json["detectable_remaining"] = verdict->detectable_remaining;
    json["out"] = nlohmann::ordered_json::array();
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        if (!has_axis(out_of(standing), axis)) continue;
        nlohmann::ordered_json entry{{"axis", axis}, {"name", nullptr}, {"since_s", nullptr}};
        if (standing.description) entry["name"] = axis_name(*standing.description, axis);
        if (const auto age_s = excluded_for_s(standing, axis)) entry["since_s"] = *age_s;
        json["out"].push_back(entry);
    }
    return json;
}

}  // namespace quorient::report
