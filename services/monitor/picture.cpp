#include "picture.hpp"

#include "axis_state.hpp"
#include "quorient/bus/settings.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/messages/words.hpp"
#include "quorient/rotation/euler.hpp"

#include <fmt/format.h>
#include <cmath>
#include <cstdlib>

namespace quorient::monitor {

using Json = nlohmann::json;

namespace {

Json euler_deg(const std::array<double, 4>& q)
{
    const auto [roll, pitch, yaw] = rotation::roll_pitch_yaw(q);
    return {{"roll", rounded(roll / degree, 7)}, {"pitch", rounded(pitch / degree, 7)}, {"yaw", rounded(yaw / degree, 7)}};
}

Json attitude_json(const Tick& tick)
{
    if (!tick.voted_fresh) return nullptr;
    const auto& voted = tick.voted;
    const bool usable = rotation::is_attitude(voted.attitude) && level_of(voted) != VoteLevel::lost;
    return {{"quaternion", usable ? Json(voted.attitude) : Json(nullptr)},
            {"euler_deg", usable ? euler_deg(voted.attitude) : Json(nullptr)},
            {"sigma_rad", rounded(voted.angle_sigma_rad)},
            {"spread_rad", rounded(voted.spread_rad)},
            {"error_rad", rounded(tick.error_rad)},
            {"rate_rad_s", {rounded(voted.rate_rad_s[0]), rounded(voted.rate_rad_s[1]), rounded(voted.rate_rad_s[2])}},
            {"mode", to_string(mode_of(voted))},
            {"voter", voted.voter},
            {"epoch", voted.epoch},
            {"sequence", voted.sequence},
            {"output_sequence", voted.output_sequence}};
}

/// What is wrong with an axis, from the first detector that knows it.
Json diagnosis_json(const Tick& tick, const Names& names, std::size_t axis)
{
    for (std::size_t place = 0; place < names.lanes.size(); ++place) {
        const auto& lane = tick.lane[place];
        const auto what = diagnosis_of(lane.diagnosis, axis);
        if (!lane.fresh || what == Diagnosis::none || lane.diagnosis.epoch != lane.verdict.epoch) continue;
        return {{"lane", names.lanes[place]}, {"what", to_string(what)}, {"size", rounded(lane.diagnosis.size[axis])},
                {"sigma", rounded(lane.diagnosis.sigma[axis])}};
    }
    return nullptr;
}

Json axes_json(const Tick& tick, const Names& names)
{
    Json axes = Json::array();
    const std::size_t count = tick.described ? std::min<std::size_t>(tick.description.axis_count, max_axes) : 0;
    for (std::size_t axis = 0; axis < count; ++axis) {
        Json lanes = Json::array();
        for (std::size_t place = 0; place < names.lanes.size(); ++place) lanes.push_back(to_string(state_in_lane(tick.lane[place], axis)));
        axes.push_back({{"axis", axis},
                        {"name", axis_name(tick.description, axis)},
                        {"instrument", tick.description.instrument[axis]},
                        {"state", to_string(state_in_system(tick, names.lanes.size(), axis))},
                        {"lanes", std::move(lanes)},
                        {"diagnosis", diagnosis_json(tick, names, axis)}});
    }
    return axes;
}

Json lanes_json(const Tick& tick, const Names& names)
{
    Json lanes = Json::array();
    for (std::size_t place = 0; place < names.lanes.size(); ++place) {
        const auto& lane = tick.lane[place];
        lanes.push_back({{"name", names.lanes[place]},
                         {"verdict", lane.fresh ? to_string(state_of(lane.verdict)) : "SILENT"},
                         {"standing", standing(tick, names, place)},
                         {"statistic", rounded(lane.verdict.statistic)},
                         {"threshold", rounded(lane.verdict.threshold)},
                         {"verdicts", lane.verdicts}});
    }
    return lanes;
}

Json services_json(const Tick& tick)
{
    Json services = Json::array();
    for (std::size_t place = 0; place < tick.services; ++place) {
        const auto& service = tick.service[place];
        const auto& status = service.status;
        services.push_back({{"name", text_of(status.name)},
                            {"role", to_string(role_of(status))},
                            {"state", to_string(state_of(status))},
                            {"vendor", bus::to_string(vendor_of(status))},
                            {"transport", bus::to_string(transport_of(status))},
                            {"rate_hz", rounded(service.rate_hz, 4)},
                            {"latency_p50_s", rounded(status.latency_s[0], 3)},
                            {"latency_p99_s", rounded(status.latency_s[2], 3)},
                            {"gaps", status.gaps},
                            {"late", status.late},
                            {"foreign", status.foreign},
                            {"rejected", status.rejected},
                            {"age_s", rounded(service.age_s, 3)},
                            {"restarts", service.restarts}});
    }
    return services;
}

}  // namespace

Names::Names(const system::System& its_system)
    : system(its_system.name),
      unit(its_system.unit),
      has_attitude(its_system.has_attitude()),
      orders(its_system.web_monitor && its_system.web_monitor->allow_orders),
      token(orders && !its_system.web_monitor->token_file.empty())
{
    for (const auto& lane : its_system.lanes) {
        lanes.push_back(lane.name);
        lane_ids.push_back(lane.detector.lane);
    }
}

Json rounded(double value, int digits)
{
    if (!std::isfinite(value)) return nullptr;
    return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
}

std::string dumped(const Json& value)
{
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string_view level_word(const Tick& tick)
{
    return tick.voted_fresh ? to_string(level_of(tick.voted)) : "NO OUTPUT";
}

std::string_view standing(const Tick& tick, const Names& names, std::size_t place)
{
    if (!tick.voted_fresh) return "unknown";
    if (tick.voted.primary_lane == names.lane_ids[place]) return "primary";
    if ((tick.voted.vouching_mask >> place & 1U) != 0) return "vouches";
    return to_string(exclusion_of(tick.voted, place));
}

Json picture(const Tick& tick, const Names& names)
{
    return {{"system", names.system},
            {"unit", names.unit},
            {"unit_name", tick.described ? Json(text_of(tick.description.name)) : Json(nullptr)},
            {"kind", tick.described ? Json(to_string(kind_of(tick.description))) : Json(nullptr)},
            {"interval_s", tick.described ? rounded(tick.description.interval_s, 9) : Json(nullptr)},
            {"has_attitude", names.has_attitude},
            {"orders", names.orders},
            {"token", names.token},
            {"tick", tick.number},
            {"wall_time_ms", tick.wall_time_ns / 1'000'000},
            {"level", level_word(tick)},
            {"output_age_s", rounded(tick.voted_age_s, 3)},
            {"attitude", attitude_json(tick)},
            {"axes", axes_json(tick, names)},
            {"lanes", lanes_json(tick, names)},
            {"services", services_json(tick)},
            {"events_lost", tick.events_lost},
            {"ticks_deferred", tick.ticks_deferred}};
}

Json event_json(const HealthEvent& event)
{
    Json axes = Json::array();
    for (std::size_t axis = 0; axis < max_axes; ++axis)
        if (has_axis(event.axes, axis)) axes.push_back(axis);
    return {{"wall_time_ms", event.wall_time_ns / 1'000'000},
            {"severity", to_string(severity_of(event))},
            {"source", text_of(event.source_name)},
            {"number", event.event_number},
            {"code", to_string(code_of(event))},
            {"axes", std::move(axes)},
            {"request", event.request == 0 ? Json(nullptr) : Json(std::to_string(event.request))},
            {"text", text_of(event.text)}};
}

Json sample_json(const Sample& sample)
{
    Json lanes = Json::array();
    for (std::size_t place = 0; place < sample.lanes; ++place) {
        Json low = Json::array();
        Json high = Json::array();
        Json bound = Json::array();
        for (std::size_t axis = 0; axis < sample.axes; ++axis) {
            low.push_back(rounded(sample.lane[place].residual[axis].lowest, 4));
            high.push_back(rounded(sample.lane[place].residual[axis].highest, 4));
            bound.push_back(rounded(sample.lane[place].bound[axis], 4));
        }
        lanes.push_back({{"low", std::move(low)}, {"high", std::move(high)}, {"bound", std::move(bound)}});
    }
    std::string states;
    for (std::size_t axis = 0; axis < sample.axes; ++axis) states += static_cast<char>('0' + static_cast<int>(sample.axis[axis]));
    return {{"t", sample.wall_time_ns / 1'000'000},
            {"sigma", rounded(sample.sigma_rad)},
            {"error", {rounded(sample.error.lowest), rounded(sample.error.highest)}},
            {"lanes", std::move(lanes)},
            {"states", states}};
}

}  // namespace quorient::monitor
