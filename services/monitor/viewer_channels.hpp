#pragma once

#include "picture.hpp"
#include "tick.hpp"

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace quorient::monitor {

/// What a viewer such as Foxglove can subscribe: messages in JSON, described by a JSON schema.
enum class ViewerChannel : std::size_t { transform, attitude, level, lanes, axes, log };

inline constexpr std::size_t viewer_channels = 6;

/// As the viewer's protocol advertises them: id, topic, encoding, schemaName, schema, schemaEncoding.
nlohmann::json advertised_channels();

/// The messages of this channel that a tick makes: one, or none (no attitude), or as many as there are new events.
std::vector<nlohmann::json> viewer_messages(ViewerChannel channel, const Tick& tick, const Names& names);

}  // namespace quorient::monitor
