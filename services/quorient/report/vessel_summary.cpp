#include "vessel_summary.hpp"

#include "cli/json_output.hpp"
#include "quorient/bus/settings.hpp"

#include <fmt/format.h>

namespace quorient::report {

namespace {

constexpr double least_share_of_verdicts = 0.9;

std::string observed_axis(const evaluation::RunObserver& run, std::size_t axis)
{
    return run.names_of(axis_bit(axis));
}

std::string period(const evaluation::Spell& spell)
{
    return fmt::format("from {:.2f} s{}", spell.begin_s, spell.end_s ? fmt::format(" to {:.2f} s", *spell.end_s) : " on");
}

std::string reaction_text(const evaluation::Spell& fault, const evaluation::Reaction& reaction)
{
    if (!reaction.isolated_s) return "not isolated";
    const auto trusted = reaction.trusted_s ? fmt::format(", trusted again at {:.2f} s", *reaction.trusted_s) : ", held to the end";
    return fmt::format("isolated at {:.2f} s ({:.2f} s after){}", *reaction.isolated_s, *reaction.isolated_s - fault.begin_s, trusted);
}

nlohmann::ordered_json lane_json(const evaluation::RunObserver& run, const evaluation::LaneRecord& lane)
{
    nlohmann::ordered_json json{{"vendor", bus::to_string(lane.vendor)}, {"verdicts", lane.verdicts}, {"suspicious", lane.suspicious}};
    json["faults"] = nlohmann::ordered_json::array();
    for (const evaluation::Spell& fault : run.faults().all()) {
        const auto made = reaction(fault, lane.isolated);
        json["faults"].push_back({{"isolated_s", cli::or_null(made.isolated_s)}, {"trusted_s", cli::or_null(made.trusted_s)}});
    }
    json["false_isolations"] = nlohmann::ordered_json::array();
    for (const evaluation::Spell& spell : false_isolations(run.faults(), lane.isolated))
        json["false_isolations"].push_back({{"axis", spell.axis}, {"begin_s", spell.begin_s}, {"end_s", cli::or_null(spell.end_s)}});
    return json;
}

void judge(const system::System& system, const evaluation::RunObserver& run, const evaluation::LaneRecord& lane, std::vector<std::string>& failures)
{
    if (static_cast<double>(lane.verdicts) < least_share_of_verdicts * static_cast<double>(run.truth_frames()) || lane.verdicts == 0)
        failures.push_back(fmt::format("lane {} gave {} verdicts for {} frames", lane.name, lane.verdicts, run.truth_frames()));
    for (const evaluation::Spell& fault : run.faults().all()) {
        const auto made = reaction(fault, lane.isolated);
        const auto what = fmt::format("lane {}, {}, faulty {}", lane.name, observed_axis(run, fault.axis), period(fault));
        if (!made.isolated_s || *made.isolated_s - fault.begin_s > *system.expectations.each_fault_within_s)
            failures.push_back(
                fmt::format("{}: {}, {} s allowed", what, reaction_text(fault, made), *system.expectations.each_fault_within_s));
        else if (made.trusted_s && (!fault.end_s || *made.trusted_s < *fault.end_s))
            failures.push_back(fmt::format("{}: trusted again at {:.2f} s", what, *made.trusted_s));
    }
    for (const evaluation::Spell& spell : false_isolations(run.faults(), lane.isolated))
        failures.push_back(fmt::format("lane {} isolated {} {}, without a fault", lane.name, observed_axis(run, spell.axis), period(spell)));
}

}  // namespace

std::string vessel_text(const system::System& system, const evaluation::RunObserver& run)
{
    std::string text = fmt::format("{}: {} frames\n", system.name, run.truth_frames());
    if (run.faults().all().empty()) text += "fault    none\n";
    for (const evaluation::Spell& fault : run.faults().all()) {
        text += fmt::format("fault    {} {}\n", observed_axis(run, fault.axis), period(fault));
        for (const evaluation::LaneRecord& lane : run.lanes())
            text += fmt::format("  lane {:<4}{:<11}{}\n", lane.name, bus::to_string(lane.vendor),
                                reaction_text(fault, reaction(fault, lane.isolated)));
    }
    for (const evaluation::LaneRecord& lane : run.lanes()) {
        const auto wrong = false_isolations(run.faults(), lane.isolated);
        text += fmt::format("lane {:<4}{} verdicts, {} suspicious; isolated without a fault: {}\n", lane.name, lane.verdicts,
                            lane.suspicious, wrong.empty() ? "nothing" : fmt::format("{} times", wrong.size()));
    }
    return text + "no integrators, no voters: a vessel's rates give no attitude\n";
}

nlohmann::ordered_json vessel_json(const system::System& system, const evaluation::RunObserver& run)
{
    nlohmann::ordered_json json{{"system", system.name}, {"frames", run.truth_frames()}};
    json["faults"] = nlohmann::ordered_json::array();
    for (const evaluation::Spell& fault : run.faults().all())
        json["faults"].push_back({{"axis", fault.axis}, {"begin_s", fault.begin_s}, {"end_s", cli::or_null(fault.end_s)}});
    for (const evaluation::LaneRecord& lane : run.lanes()) json["lanes"][lane.name] = lane_json(run, lane);
    return json;
}

std::vector<std::string> unmet_faults(const system::System& system, const evaluation::RunObserver& run)
{
    std::vector<std::string> failures;
    if (!system.expectations.each_fault_within_s) return failures;
    if (run.faults().all().empty() && !system.sensor.source.scenario.faults.empty()) failures.emplace_back("the fault never took effect");
    for (const evaluation::LaneRecord& lane : run.lanes()) judge(system, run, lane, failures);
    return failures;
}

}  // namespace quorient::report
