#include "summary.hpp"

#include "cli/json_output.hpp"
#include "quorient/bus/settings.hpp"
#include "quorient/messages/diagnosis_text.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/words.hpp"
#include "undecided.hpp"
#include "vessel_summary.hpp"

#include <fmt/format.h>
#include <bit>

namespace quorient::report {

namespace {

std::string error_text(const evaluation::Errors& errors)
{
    if (errors.compared == 0) return "no truth to compare with";
    return fmt::format("largest {:.2e}, final {:.2e} rad", errors.largest_rad, errors.final_rad);
}

std::string triad_text(const evaluation::RunObserver& run, AxisMask used)
{
    if (used == 0) return "-";
    return fmt::format("{} {}", std::popcount(used) == 3 ? "working triad" : "working", run.names_of(used));
}

std::string isolation_text(const evaluation::RunObserver& run, const evaluation::LaneRecord& lane)
{
    if (!lane.isolated_at) return "isolated nothing";
    const auto frames = run.frames_to_isolation(lane);
    return fmt::format("isolated {} at {:.3f} s{}, {}", run.names_of(lane.isolated_first), run.time_s(*lane.isolated_at),
                       frames ? fmt::format(" ({} frame{} into the fault)", *frames, *frames == 1 ? "" : "s") : "",
                       triad_text(run, lane.triad_after));
}

/// What is wrong with the axes that the lane isolated, as far as it knows at the end.
std::string diagnosis_of(const evaluation::RunObserver& run, const evaluation::LaneRecord& lane)
{
    return run.description() ? diagnoses_text(lane.diagnosis, *run.description(), lane.isolated_ever) : std::string{};
}

/// The axes that the expectation allows and demands.
bool as_expected(const system::System& system, const evaluation::RunObserver& run, AxisMask isolated)
{
    const auto& expect = system.expectations;
    if (expect.isolated) return isolated == *expect.isolated;
    if (!expect.instrument) return true;
    if (isolated == 0 || !run.description()) return false;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        if (!has_axis(isolated, axis)) continue;
        const auto instrument = run.description()->instrument[axis];
        if (text_of(run.description()->instrument_name[instrument]) != *expect.instrument) return false;
    }
    return true;
}

/// A publisher of the user's own sends frames without their truth: there is nothing to compare them with.
std::string summary_without_truth(const system::System& system, const evaluation::RunObserver& run)
{
    std::string text = fmt::format("{}: no truth was published, so neither faults nor errors nor missing frames are known\n", system.name);
    for (const auto& lane : run.lanes())
        text += fmt::format("lane {:<4}{:<11}{} frames, {}\n", lane.name, bus::to_string(lane.vendor), lane.frames, isolation_text(run, lane));
    return text + fmt::format("voted    {} frames, level {}\n", run.voted().frames, to_string(run.final_level()));
}

nlohmann::ordered_json errors_json(const evaluation::Errors& errors)
{
    if (errors.compared == 0) return {{"compared", 0}, {"max_error_rad", nullptr}, {"final_error_rad", nullptr}};
    return {{"compared", errors.compared}, {"max_error_rad", errors.largest_rad}, {"final_error_rad", errors.final_rad}};
}

}  // namespace

std::string summary_text(const system::System& system, const evaluation::RunObserver& run)
{
    if (system.integrators().empty()) return vessel_text(system, run);
    if (run.truth_frames() == 0) return summary_without_truth(system, run);
    std::string text = fmt::format("{}: {} frames\n", system.name, run.truth_frames());
    if (run.fault_began())
        text += fmt::format("fault    {} from {:.3f} s{}\n", run.names_of(run.faulty()), run.time_s(*run.fault_began()),
                            run.fault_ended() ? fmt::format(" to {:.3f} s", run.time_s(*run.fault_ended())) : "");
    else text += fmt::format("fault    none{}\n", system.sensor.source.log ? " added to the log" : "");
    for (const auto& lane : run.lanes()) {
        text += fmt::format("lane {:<4}{:<11}{}\n", lane.name, bus::to_string(lane.vendor), isolation_text(run, lane));
        if (const auto diagnosis = diagnosis_of(run, lane); !diagnosis.empty()) text += fmt::format("{:20}{}\n", "", diagnosis);
        text += fmt::format("{:20}attitude error {}; {} frames lost\n", "", error_text(lane.errors),
                            run.truth_frames() - std::min(lane.frames, run.truth_frames()));
    }
    const auto& voted = run.voted();
    text += fmt::format("voted    {} frames, {} missing, level {}; attitude error {}\n", voted.frames, run.missing_voted(),
                        to_string(run.final_level()), error_text(voted.errors));
    text += undecided_text(run);
    if (run.without_rollback().compared > 0)
        text += fmt::format("without roll-back and leaving out suspects (lane {}'s verdicts): attitude error {}\n",
                            run.lanes().front().name, error_text(run.without_rollback()));
    return text;
}

nlohmann::ordered_json summary_json(const system::System& system, const evaluation::RunObserver& run)
{
    nlohmann::ordered_json json;
    if (system.integrators().empty()) {
        json = vessel_json(system, run);
        json["unmet"] = unmet(system, run);
        return json;
    }
    json["system"] = system.name;
    json["frames"] = run.truth_frames();
    json["fault"] = nullptr;
    if (run.fault_began()) json["fault"] = {{"axes", cli::axes_json(run.faulty())}, {"begin_s", run.time_s(*run.fault_began())}};
    for (const auto& lane : run.lanes()) {
        auto& entry = json["lanes"][lane.name];
        entry["vendor"] = bus::to_string(lane.vendor);
        entry["frames"] = lane.frames;
        entry["isolated"] = cli::axes_json(lane.isolated_ever);
        entry["isolated_s"] = nullptr;
        if (lane.isolated_at) entry["isolated_s"] = run.time_s(*lane.isolated_at);
        entry["frames_to_isolation"] = nullptr;
        if (const auto frames = run.frames_to_isolation(lane)) entry["frames_to_isolation"] = *frames;
        entry["working"] = cli::axes_json(lane.triad_after);
        entry["diagnosis"] = diagnosis_of(run, lane);
        entry["attitude"] = errors_json(lane.errors);
    }
    json["voted"] = {{"frames", run.voted().frames},
                     {"missing", run.missing_voted()},
                     {"disordered", run.voted().disordered},
                     {"level", to_string(run.final_level())},
                     {"attitude", errors_json(run.voted().errors)}};
    json["undecided_s"] = undecided_s_json(run);
    json["undecided"] = undecided_json(run);
    json["without_rollback"] = errors_json(run.without_rollback());
    json["unmet"] = unmet(system, run);
    return json;
}

std::vector<std::string> unmet(const system::System& system, const evaluation::RunObserver& run)
{
    const auto& expect = system.expectations;
    std::vector<std::string> failures = unmet_faults(system, run);
    const auto is_idle = [](const evaluation::LaneRecord& lane) { return lane.frames == 0 && lane.verdicts == 0; };
    if (run.truth_frames() == 0 && std::ranges::all_of(run.lanes(), is_idle)) failures.emplace_back("no frame came");
    if (!expect.any()) return failures;
    // A log may hold a fault that nobody stated.
    const bool all_stated = !system.sensor.source.log || !system.sensor.source.scenario.faults.empty();
    if ((expect.within_frames || (all_stated && expect.isolated && *expect.isolated != 0)) && !run.fault_began())
        failures.emplace_back("the fault never took effect");
    for (const auto& lane : run.lanes()) {
        if (!as_expected(system, run, lane.isolated_ever))
            failures.push_back(fmt::format("lane {} isolated {}", lane.name, run.names_of(lane.isolated_ever)));
        const auto frames = run.frames_to_isolation(lane);
        if (expect.within_frames && (!frames || *frames > *expect.within_frames))
            failures.push_back(fmt::format("lane {} isolated after {} frames, {} allowed", lane.name,
                                           frames ? std::to_string(*frames) : "no", *expect.within_frames));
    }
    const auto& voted = run.voted();
    if (expect.no_gap && (run.missing_voted() > 0 || voted.disordered > 0 || voted.frames == 0))
        failures.push_back(
            fmt::format("voted stream: {} frames, {} missing, {} out of order", voted.frames, run.missing_voted(), voted.disordered));
    if (expect.final_error_rad && !(voted.errors.compared > 0 && voted.errors.final_rad < *expect.final_error_rad))
        failures.push_back(fmt::format("final voted attitude error {:.3e} rad, {:.3e} allowed ({} frames compared)", voted.errors.final_rad,
                                       *expect.final_error_rad, voted.errors.compared));
    return failures;
}

}  // namespace quorient::report
