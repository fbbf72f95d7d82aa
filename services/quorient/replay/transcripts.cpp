#include "transcripts.hpp"

#include "cli/json_output.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <cmath>
#include <map>
#include <memory>

namespace quorient::replay {

namespace {

std::string numbers_of(AxisMask axes)
{
    std::string text;
    for (std::size_t axis = 0; axis < max_axes; ++axis)
        if (has_axis(axes, axis)) text += fmt::format("{}{}", text.empty() ? "" : " ", axis);
    return text;
}

/// 17 significant digits; what is not finite is an empty cell.
std::string cell_of(double value)
{
    return std::isfinite(value) ? fmt::format("{:.17g}", value) : std::string{};
}

}  // namespace

void write_verdicts(Offline& offline, const system::System& system, cli::OutputFile& out)
{
    std::map<std::uint32_t, std::string> lanes;
    for (const auto& lane : system.lanes) lanes[lane.detector.detector] = lane.name;
    offline.watch(bus::topics::verdict, [&out, lanes, begun = false](const FaultVerdict& verdict) mutable {
        if (!begun) out.stream() << "time_s,lane,sequence,state,isolated,suspect,left_out,statistic,threshold,detectable_remaining\n";
        begun = true;
        const auto lane = lanes.find(verdict.detector);
        const AxisMask left_out = verdict.isolated_mask | provisional_mask(verdict);
        out.stream() << fmt::format("{:.9f},{},{},{},{},{},{},{},{},{}\n", static_cast<double>(verdict.sample_time_ns) * 1e-9,
                           lane == lanes.end() ? std::to_string(verdict.detector) : lane->second, verdict.sequence, to_string(state_of(verdict)),
                           numbers_of(verdict.isolated_mask), numbers_of(verdict.suspect_mask), numbers_of(left_out), cell_of(verdict.statistic),
                           cell_of(verdict.threshold), verdict.detectable_remaining);
    });
}

void write_events(Offline& offline, cli::OutputFile& out)
{
    const auto newest_s = std::make_shared<double>(0);
    offline.watch(bus::topics::frame, [newest_s](const SensorFrame& frame) { *newest_s = static_cast<double>(frame.sample_time_ns) * 1e-9; });
    offline.watch(bus::topics::event, [newest_s, &out](const HealthEvent& event) {
        const nlohmann::ordered_json line{{"time_s", *newest_s},
                                          {"source", std::string(text_of(event.source_name))},
                                          {"severity", to_string(severity_of(event))},
                                          {"code", to_string(code_of(event))},
                                          {"axes", cli::axes_json(event.axes)},
                                          {"sequence", event.sequence},
                                          {"text", std::string(text_of(event.text))}};
        out.stream() << cli::dump(line) + '\n';
    });
}

}  // namespace quorient::replay
