#include "parse_vessel.hpp"

#include "quorient/system/plant.hpp"

#include <fmt/format.h>

namespace quorient::system {

using runtime::Section;

void parse_vessel_unit(Section& unit, System& system)
{
    auto model = simulation::nomoto({}).value();
    if (parse_plant(unit, model)) system.vessel = model;
    if (!unit.has("plant")) system.channels = {"sway_velocity", "yaw_rate"};
    unit.texts("channels", system.channels);
    if (system.vessel && !system.channels.empty() && system.channels.size() != static_cast<std::size_t>(model.c.rows()))
        unit.problem("channels", fmt::format("{} names for {} channels", system.channels.size(), model.c.rows()));
    for (const auto& channel : system.channels)
        if (channel.size() > 15) unit.problem("channels", fmt::format("'{}' has more than 15 characters", channel));
    std::string input = "rudder";
    unit.text("known_input", input);
    if (input != "rudder") unit.problem("known_input", fmt::format("unknown input '{}'; there is rudder", input));
}

void parse_vessel_source(Section& source, System& system)
{
    std::string kind = "simulation";
    source.text("kind", kind);
    if (kind != "simulation") source.problem("kind", "a vessel's rates come from a simulation: no log format holds a rudder");
    auto& scenario = system.sensor.source.vessel.emplace();
    scenario.channels = system.channels;
    if (system.vessel) scenario.model = *system.vessel;
    const bool has_model = parse_plant(source, scenario.model) && scenario.model.a.size() > 0;
    double rate_hz = 100;
    source.number("rate_hz", rate_hz, {.lowest = 1, .highest = 20'000, .unit = "Hz"});
    system.interval_s = scenario.interval_s = 1 / rate_hz;
    source.number("duration_s", scenario.duration_s, {.lowest = 0, .unit = "s"});
    source.number("noise", scenario.noise, runtime::not_negative);
    source.whole("seed", scenario.seed);
    source.number("speed", system.sensor.source.speed, runtime::above_zero);
    Section rudder = source.section("rudder");
    rudder.number("amplitude_rad", scenario.rudder_rad, {.unit = "rad"});
    rudder.number("period_s", scenario.rudder_period_s, runtime::above_zero);
    rudder.number("lost_from_s", scenario.rudder_lost_from_s, runtime::not_negative);
    rudder.number("lost_to_s", scenario.rudder_lost_to_s, runtime::not_negative);
    rudder.finish();

    const auto set_up = simulation::check(scenario);
    if (has_model && !set_up) source.problem("kind", set_up.error());
    std::vector<std::string> texts;
    source.texts("faults", texts);
    for (const auto& text : texts) {
        auto fault = simulation::parse_fault(text);
        if (fault && set_up) fault = simulation::resolve(*fault, simulation::channels_of(scenario));
        if (fault) scenario.faults.push_back(*fault);
        else source.problem("faults", fault.error());
    }
    system.sensor.source.scenario.faults = scenario.faults;
    source.finish();
}

}  // namespace quorient::system
