#pragma once

#include "quorient/bus/sender.hpp"

#include <optional>
#include <string>

namespace quorient::bus::fastdds {

/// An endpoint of another participant that Fast DDS refused, because its permissions omit the topic.
struct RefusedEndpoint {
    GuidPrefix participant{};
    bool publishes = false;
    std::string topic;
};

/// Reads it from an entry of the library's log, the only place where Fast DDS 2.9 reports it. @returns nothing for any other entry.
std::optional<RefusedEndpoint> refused_endpoint(const std::string& entry);

/// Whether an entry only announces the one that names the endpoint.
bool announces_refused_endpoint(const std::string& entry);

}  // namespace quorient::bus::fastdds
