#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::security {

/// The role of a node; it decides which topics the node may publish and subscribe.
enum class Role : std::uint8_t {
    sensor,
    detector,
    integrator,
    voter,
    monitor,        ///< subscribes to everything, publishes nothing
    commander,      ///< subscribes to everything, publishes orders; its word is "operator"
    consumer,       ///< subscribes to `quorient/voted` and to the topics for ROS 2
};

/// Names of topics, in the order of bus::topics::all.
struct Access {
    std::vector<std::string> publishes;
    std::vector<std::string> subscribes;

    bool operator==(const Access&) const = default;
};

/// The topics of a role by the wire contract (idl/README.md). system::members_of adds the topics of ROS 2.
Access access_of(Role role);

/// @returns an error that lists the words, e.g. for "admin".
tl::expected<Role, std::string> role_from(std::string_view word);
std::string_view to_string(Role role);

}  // namespace quorient::security
