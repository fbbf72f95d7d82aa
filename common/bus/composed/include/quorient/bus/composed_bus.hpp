#pragma once

#include "quorient/bus/bus.hpp"

#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::bus {

/// The bus of several services in one process: one participant, one thread. A sample that a service publishes goes straight into the
/// queues of the services beside it, and to the vendor, for all processes outside. What comes from outside is read once for all of them.
///
/// - What services of this process wait for goes outside when the round of the event loop is over, by flush(): first the topic that was
///   written to last, each topic in its order. So the result of a chain is not held up by the samples that led to it. All other topics go
///   at once. Where the vendor refuses such a sample, the next write() of the same publisher returns false.
/// - A subscriber gets every sample once, those of one writer in their order. A late subscriber gets the history of transient-local topics.
/// - A queue keeps the newest 64 times the topic's depth, more than the vendor holds for as many writers.
/// - Nothing is allocated per sample once the queues have reached their size.
/// - Exclusive topics and ROS 2's types stay with the vendor alone (own_samples.hpp).
/// - matched counts hold the endpoints inside and outside.
///
/// @returns as open() does; a local bus needs no composition, and is refused.
tl::expected<std::unique_ptr<Bus>, std::string> open_composed(const Settings& settings);

/// The same over a bus that is there, whose readers skip its own samples.
std::unique_ptr<Bus> compose(std::unique_ptr<Bus> outside);

}  // namespace quorient::bus
