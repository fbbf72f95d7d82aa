#pragma once

#include "quorient/bus/qos.hpp"
#include "quorient/bus/settings.hpp"

#include <cstdint>

namespace quorient::bus {

/// How many samples a writer keeps for readers that ask for them again.
///
/// For an exclusive writer on loopback these are the samples of one lease. A reader that discovers a writer late asks for all samples since
/// that writer discovered the reader. If the owner has died, the reader has received nothing for a lease. So what it is sent again is newer
/// than what it already has. On a network lost samples need several attempts, and a writer keeps the topic's depth.
std::int32_t kept_samples(const Qos& qos, const WriterOptions& options, const Settings& settings);

}  // namespace quorient::bus
