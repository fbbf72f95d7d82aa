#pragma once

#include "quorient/bus/bus.hpp"

#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::bus {

/// The bus of several services in one process: one participant, one thread. A sample that a service publishes goes to the vendor, for
/// all processes outside, and straight into the queues of the services beside it. What comes from outside is read once for all of them.
///
/// - A subscriber gets every sample once, those of one writer in their order. A late subscriber gets the history of transient-local topics.
/// - A queue keeps the newest 64 times the topic's depth, more than the vendor holds for as many writers.
/// - Nothing is allocated per sample once the queues have reached their size.
/// - Exclusive topics and ROS 2's types stay with the vendor alone (own_samples.hpp).
/// - matched counts hold the endpoints inside and outside.
///
/// @returns as open() does; a local bus needs no composition, and is refused.
tl::expected<std::unique_ptr<Bus>, std::string> open_composed(const Settings& settings);

}  // namespace quorient::bus
