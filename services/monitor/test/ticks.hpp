// Messages of the demo's unit, as tests of the monitor need them.
#pragma once

#include "collector.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <stdexcept>

namespace quorient::monitor::test {

inline system::System demo(const std::vector<std::string>& set = {"monitor.port=0"})
{
    auto loaded = system::load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml", {.dds = {}, .domain = {}, .processes = {}, .set = set});
    if (!loaded) throw std::runtime_error(loaded.error());
    return std::move(*loaded);
}

inline ClusterDescription description()
{
    ClusterDescription message;
    message.unit = 1;
    message.interval_s = 0.005;
    message.axis_count = 4;
    message.kind = octet(SensorKind::gyro);
    for (std::uint8_t axis = 0; axis < 4; ++axis) {
        message.instrument[axis] = axis;
        copy_text("G" + std::to_string(axis + 1), message.instrument_name[axis]);
    }
    return message;
}

inline FaultVerdict verdict(std::uint64_t sequence, VerdictState state = VerdictState::healthy, AxisMask isolated = 0)
{
    FaultVerdict message;
    message.unit = 1;
    message.detector = 1;
    message.epoch = 7;
    message.sequence = sequence;
    message.state = octet(state);
    message.isolated_mask = isolated;
    message.excluded_from.exclude(isolated, sequence);
    message.bound.fill(1e-6);
    return message;
}

inline VotedAttitude voted(std::uint64_t sequence, AxisMask isolated = 0)
{
    VotedAttitude message;
    message.unit = 1;
    message.voter = 1;
    message.epoch = 7;
    message.sequence = sequence;
    message.primary_lane = 1;
    message.vouching_mask = 0b111;
    message.level = octet(VoteLevel::full);
    message.mode = octet(AttitudeMode::normal);
    message.isolated_mask = isolated;
    message.excluded_from.exclude(isolated, sequence);
    return message;
}

inline HealthEvent event(std::uint64_t number, std::string_view text)
{
    HealthEvent message;
    message.unit = 1;
    message.wall_time_ns = static_cast<std::int64_t>(number) * 1'000'000'000;
    message.event_number = number;
    message.code = octet(EventCode::isolated);
    message.severity = octet(Severity::warning_high);
    copy_text("fdi-a", message.source_name);
    copy_text(text, message.text);
    return message;
}

}  // namespace quorient::monitor::test
