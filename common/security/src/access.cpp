#include "quorient/security/access.hpp"

#include "quorient/bus/topics.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <initializer_list>
#include <tuple>
#include <utility>

namespace quorient::security {

namespace {

using bus::TopicSpec;
namespace topics = bus::topics;

constexpr std::array roles{std::pair{Role::sensor, "sensor"},         std::pair{Role::detector, "detector"},
                           std::pair{Role::integrator, "integrator"}, std::pair{Role::voter, "voter"},
                           std::pair{Role::monitor, "monitor"},       std::pair{Role::commander, "operator"},
                           std::pair{Role::consumer, "consumer"}};

std::vector<std::string> names(std::initializer_list<TopicSpec> specs)
{
    std::vector<std::string> result;
    std::apply(
        [&](const auto&... topic) {
            ([&] {
                if (std::ranges::any_of(specs, [&](const TopicSpec& spec) { return spec.type == topic.spec.type; }))
                    result.emplace_back(topic.spec.name);
            }(), ...);
        },
        topics::all);
    return result;
}

std::vector<std::string> all_names()
{
    std::vector<std::string> result;
    std::apply([&](const auto&... topic) { (result.emplace_back(topic.spec.name), ...); }, topics::all);
    return result;
}

}  // namespace

Access access_of(Role role)
{
    // Every service publishes its events and its status.
    const auto event = topics::event.spec, status = topics::status.spec, command = topics::command.spec;
    const auto cluster = topics::cluster.spec, frame = topics::frame.spec, truth = topics::truth.spec;
    const auto verdict = topics::verdict.spec, diagnosis = topics::diagnosis.spec;
    const auto attitude = topics::attitude.spec, output = topics::voter_output.spec, voted = topics::voted.spec;
    switch (role) {
        case Role::sensor:
            return {names({cluster, frame, truth, event, status}), names({status, command})};
        case Role::detector:
            return {names({verdict, diagnosis, event, status}), names({cluster, frame, attitude, output, command})};
        case Role::integrator:
            return {names({attitude, event, status}), names({cluster, frame, verdict, output, command})};
        case Role::voter:
            return {names({output, voted, event, status}), names({verdict, attitude, output})};
        case Role::monitor:
            return {{}, all_names()};
        case Role::commander:
            return {names({command}), all_names()};
        case Role::consumer:
            return {{}, names({voted})};
    }
    return {};
}

tl::expected<Role, std::string> role_from(std::string_view word)
{
    for (const auto& [role, name] : roles) {
        if (word == name) return role;
    }
    return tl::make_unexpected(
        fmt::format("unknown role '{}'; known are sensor, detector, integrator, voter, monitor, operator and consumer", word));
}

std::string_view to_string(Role role)
{
    return roles[static_cast<std::size_t>(role)].second;
}

}  // namespace quorient::security
