#include "viewer_channels.hpp"

#include "axis_state.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/messages/words.hpp"
#include "quorient/rotation/euler.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace quorient::monitor {

using Json = nlohmann::json;

namespace {

Json number()
{
    return {{"type", "number"}};
}

Json text()
{
    return {{"type", "string"}};
}

Json object(const Json& properties)
{
    return {{"type", "object"}, {"properties", properties}};
}

Json titled(const char* title, Json schema)
{
    schema["title"] = title;
    return schema;
}

Json list_of(const Json& properties)
{
    return {{"type", "array"}, {"items", object(properties)}};
}

Json time_schema()
{
    return titled("time", object({{"sec", {{"type", "integer"}}}, {"nsec", {{"type", "integer"}}}}));
}

Json time_json(std::int64_t wall_time_ns)
{
    return {{"sec", wall_time_ns / 1'000'000'000}, {"nsec", wall_time_ns % 1'000'000'000}};
}

struct Description {
    const char* topic;
    const char* schema_name;
    Json schema;
};

/// The schemas of `foxglove.…` are the viewer's own: it draws such messages.
Description description_of(ViewerChannel channel)
{
    switch (channel) {
        case ViewerChannel::transform:
            return {"/attitude/transform", "foxglove.FrameTransform",
                    object({{"timestamp", time_schema()},
                            {"parent_frame_id", text()},
                            {"child_frame_id", text()},
                            {"translation", titled("foxglove.Vector3", object({{"x", number()}, {"y", number()}, {"z", number()}}))},
                            {"rotation", titled("foxglove.Quaternion",
                                                object({{"x", number()}, {"y", number()}, {"z", number()}, {"w", number()}}))}})};
        case ViewerChannel::attitude:
            return {"/attitude", "quorient.Attitude",
                    object({{"timestamp", time_schema()},
                            {"roll_deg", number()},
                            {"pitch_deg", number()},
                            {"yaw_deg", number()},
                            {"sigma_rad", number()},
                            {"spread_rad", number()},
                            {"error_rad", number()},
                            {"largest_error_rad", number()}})};
        case ViewerChannel::level:
            return {"/level", "quorient.Level",
                    object({{"timestamp", time_schema()}, {"level", text()}, {"code", number()}, {"lanes_vouching", number()}})};
        case ViewerChannel::lanes:
            return {"/lanes", "quorient.Lanes",
                    object({{"timestamp", time_schema()},
                            {"lanes", list_of({{"name", text()},
                                               {"verdict", text()},
                                               {"standing", text()},
                                               {"statistic", number()},
                                               {"threshold", number()}})}})};
        case ViewerChannel::axes:
            return {"/axes", "quorient.Axes",
                    object({{"timestamp", time_schema()},
                            {"axes", list_of({{"name", text()},
                                              {"state", text()},
                                              {"lane", text()},
                                              {"least_residual", number()},
                                              {"largest_residual", number()},
                                              {"bound", number()}})}})};
        default:
            return {"/log", "foxglove.Log",
                    object({{"timestamp", time_schema()}, {"level", {{"type", "integer"}}}, {"message", text()}, {"name", text()}, {"file", text()},
                            {"line", {{"type", "integer"}}}})};
    }
}

std::vector<Json> transform(const Tick& tick)
{
    const auto& voted = tick.voted;
    if (!tick.voted_fresh || level_of(voted) == VoteLevel::lost || !rotation::is_attitude(voted.attitude)) return {};
    const auto [w, x, y, z] = voted.attitude;
    return {{{"timestamp", time_json(tick.wall_time_ns)},
             {"parent_frame_id", "reference"},
             {"child_frame_id", "body"},
             {"translation", {{"x", 0}, {"y", 0}, {"z", 0}}},
             {"rotation", {{"x", x}, {"y", y}, {"z", z}, {"w", w}}}}};
}

std::vector<Json> attitude(const Tick& tick)
{
    const auto& voted = tick.voted;
    if (!tick.voted_fresh || level_of(voted) == VoteLevel::lost || !rotation::is_attitude(voted.attitude)) return {};
    const auto [roll, pitch, yaw] = rotation::roll_pitch_yaw(voted.attitude);
    return {{{"timestamp", time_json(tick.wall_time_ns)},
             {"roll_deg", rounded(roll / degree, 9)},
             {"pitch_deg", rounded(pitch / degree, 9)},
             {"yaw_deg", rounded(yaw / degree, 9)},
             {"sigma_rad", rounded(voted.angle_sigma_rad)},
             {"spread_rad", rounded(voted.spread_rad)},
             {"error_rad", rounded(tick.error_rad)},
             {"largest_error_rad", rounded(tick.error.highest)}}};
}

std::vector<Json> level(const Tick& tick)
{
    const auto code = tick.voted_fresh ? level_of(tick.voted) : VoteLevel::unknown;
    return {{{"timestamp", time_json(tick.wall_time_ns)},
             {"level", level_word(tick)},
             {"code", octet(code)},
             {"lanes_vouching", tick.voted_fresh ? std::popcount(tick.voted.vouching_mask) : 0}}};
}

std::vector<Json> lanes(const Tick& tick, const Names& names)
{
    Json list = Json::array();
    for (std::size_t place = 0; place < names.lanes.size(); ++place) {
        const auto& lane = tick.lane[place];
        list.push_back({{"name", names.lanes[place]},
                        {"verdict", lane.fresh ? to_string(state_of(lane.verdict)) : "SILENT"},
                        {"standing", standing(tick, names, place)},
                        {"statistic", rounded(lane.verdict.statistic)},
                        {"threshold", rounded(lane.verdict.threshold)}});
    }
    return {{{"timestamp", time_json(tick.wall_time_ns)}, {"lanes", std::move(list)}}};
}

/// One entry per axis and lane, as plots address them.
std::vector<Json> axes(const Tick& tick, const Names& names)
{
    Json list = Json::array();
    const std::size_t count = tick.described ? std::min<std::size_t>(tick.description.axis_count, max_axes) : 0;
    for (std::size_t axis = 0; axis < count; ++axis)
        for (std::size_t place = 0; place < names.lanes.size(); ++place) {
            const auto& lane = tick.lane[place];
            list.push_back({{"name", axis_name(tick.description, axis)},
                            {"state", to_string(state_in_lane(lane, axis))},
                            {"lane", names.lanes[place]},
                            {"least_residual", rounded(lane.residual[axis].lowest)},
                            {"largest_residual", rounded(lane.residual[axis].highest)},
                            {"bound", rounded(lane.verdict.bound[axis])}});
        }
    return {{{"timestamp", time_json(tick.wall_time_ns)}, {"axes", std::move(list)}}};
}

/// foxglove.Log counts 1 debug, 2 info, 3 warning, 4 error, 5 fatal.
int log_level(Severity severity)
{
    switch (severity) {
        case Severity::warning_low:
            return 3;
        case Severity::warning_high:
            return 4;
        case Severity::fatal:
            return 5;
        default:
            return 2;
    }
}

std::vector<Json> log(const Tick& tick)
{
    std::vector<Json> messages;
    for (const auto& event : tick.events)
        messages.push_back({{"timestamp", time_json(event.wall_time_ns)},
                            {"level", log_level(severity_of(event))},
                            {"message", std::string(text_of(event.text))},
                            {"name", std::string(text_of(event.source_name))},
                            {"file", std::string(to_string(code_of(event)))},
                            {"line", event.event_number}});
    return messages;
}

}  // namespace

Json advertised_channels()
{
    Json channels = Json::array();
    for (std::size_t id = 0; id < viewer_channels; ++id) {
        const auto its = description_of(static_cast<ViewerChannel>(id));
        channels.push_back({{"id", id},
                            {"topic", its.topic},
                            {"encoding", "json"},
                            {"schemaName", its.schema_name},
                            {"schema", titled(its.schema_name, its.schema).dump()},
                            {"schemaEncoding", "jsonschema"}});
    }
    return channels;
}

std::vector<Json> viewer_messages(ViewerChannel channel, const Tick& tick, const Names& names)
{
    switch (channel) {
        case ViewerChannel::transform:
            return transform(tick);
        case ViewerChannel::attitude:
            return attitude(tick);
        case ViewerChannel::level:
            return level(tick);
        case ViewerChannel::lanes:
            return lanes(tick, names);
        case ViewerChannel::axes:
            return axes(tick, names);
        default:
            return log(tick);
    }
}

}  // namespace quorient::monitor
