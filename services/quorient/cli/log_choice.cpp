#include "log_choice.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace quorient::cli {

namespace {

using recording::RateUnit;
using recording::TimeUnit;

constexpr std::array rate_units{std::pair{"rad/s", RateUnit::rad_s}, std::pair{"deg/s", RateUnit::deg_s}, std::pair{"mrad/s", RateUnit::mrad_s},
                                std::pair{"mdeg/s", RateUnit::mdeg_s}};
constexpr std::array time_units{std::pair{"s", TimeUnit::s}, std::pair{"ms", TimeUnit::ms}, std::pair{"us", TimeUnit::us},
                                std::pair{"ns", TimeUnit::ns}};

template <class Unit, std::size_t Size>
std::optional<Unit> unit_named(const std::optional<std::string>& name, const std::array<std::pair<const char*, Unit>, Size>& units)
{
    const auto found = std::find_if(units.begin(), units.end(), [&](const auto& unit) { return name == unit.first; });
    return found == units.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

void LogChoice::add_to(Verb& verb)
{
    verb.option("--unit", unit, "of the rates in a CSV that does not say it").one_of({"rad/s", "deg/s", "mrad/s", "mdeg/s"});
    verb.option("--time-unit", time_unit, "of the times in a CSV that does not say it").one_of({"s", "ms", "us", "ns"});
    verb.option("--lsb-per-deg-s", lsb_per_deg_s, "the rates in a CSV are raw counts, so many per deg/s").within(settings::above_zero);
}

recording::LogOptions LogChoice::options() const
{
    return {unit_named(unit, rate_units), lsb_per_deg_s, unit_named(time_unit, time_units)};
}

}  // namespace quorient::cli
