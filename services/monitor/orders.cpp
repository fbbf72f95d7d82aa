#include "orders.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/rotation/quaternion.hpp"
#include "quorient/simulation/faults.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace quorient::monitor {
namespace {

using Json = nlohmann::json;
using Order = tl::expected<FaultCommand, std::string>;

Order inject(const Json& json)
{
    const auto fault = simulation::parse_fault(json.value("fault", ""));
    if (!fault) return tl::unexpected(fault.error());
    if (fault->axes == 0) return tl::unexpected(std::string{"a live fault names its axis: axis=1,..."});
    return simulation::to_command(*fault);
}

Order readmit(const Json& json)
{
    FaultCommand command;
    command.action = octet(CommandAction::readmit);
    for (const auto axis : json.value("axes", std::vector<std::uint64_t>{})) {
        if (axis >= max_axes) return tl::unexpected(fmt::format("axes: {} is none of 0 to {}", axis, max_axes - 1));
        command.axes |= axis_bit(axis);
    }
    if (command.axes == 0) return tl::unexpected(std::string{"axes: which ones?"});
    return command;
}

Order reset(const Json& json)
{
    FaultCommand command;
    command.action = octet(CommandAction::reset_attitude);
    const auto attitude = json.value("attitude", std::vector<double>{});
    if (attitude.size() == 4) std::copy(attitude.begin(), attitude.end(), command.attitude.begin());
    if (attitude.size() != 4 || !rotation::is_attitude(command.attitude))
        return tl::unexpected(std::string{"attitude: a unit quaternion [w, x, y, z] is needed"});
    return command;
}

}  // namespace

Order order_from(const std::string& text)
{
    try {
        const auto json = Json::parse(text);
        const auto action = json.value("action", "");
        if (action == "inject") return inject(json);
        if (action == "readmit") return readmit(json);
        if (action == "reset") return reset(json);
        if (action != "clear") return tl::unexpected(std::string{"action: one of inject, clear, readmit, reset"});
        FaultCommand command;
        command.action = octet(CommandAction::clear);
        return command;
    } catch (const Json::exception& error) {
        return tl::unexpected(fmt::format("this is no order: {}", error.what()));
    }
}

}  // namespace quorient::monitor
