#include "quorient/runtime/describe.hpp"

#include "quorient/messages/codes.hpp"
#include "quorient/messages/limits.hpp"
#include "quorient/runtime/text.hpp"

#include <fmt/format.h>

namespace quorient::runtime {

std::string describe_axes(std::uint32_t mask, const ClusterDescription& description)
{
    if (description.kind != static_cast<std::uint8_t>(SensorKind::vessel_rates)) return describe_axes(mask);
    std::string list;
    for (std::size_t channel = 0; channel < max_axes; ++channel) {
        if (!has_axis(mask, channel)) continue;
        const std::size_t instrument = description.instrument[channel];
        const auto name = instrument < max_axes ? text_of(description.instrument_name[instrument]) : std::string_view{};
        list += fmt::format("{}channel {} ({})", list.empty() ? "" : ", ", channel, name);
    }
    return list.empty() ? "no channel" : list;
}

}  // namespace quorient::runtime
