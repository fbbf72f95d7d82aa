#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace quorient::bus::fastdds {

/// A datagram of another vendor, with its ACKNACKs [RTPS 9.4.5.3] to built-in writers rewritten into the form to which Fast DDS replies:
/// counted from 1, and with base 0 from a reader that has received nothing yet (base 1, nothing requested, an answer wanted).
/// Signed submessages stay as they are.
/// @param data  a datagram that `is_sound_rtps`
/// @returns nothing where the datagram needs no change.
///
/// Why: Cyclone DDS ignores heartbeats of a node that it has not discovered. After discovery it requests one with count 0. Fast DDS 2.9.1
/// accepts only counts above 0, and replies at once only to base 0; its own next heartbeat follows up to 1 s later. Until then neither side
/// knows the other's endpoints, and a standby voter does not receive the voter that it stands by for.
std::optional<std::vector<std::uint8_t>> with_understood_acknacks(const std::uint8_t* data, std::size_t size);

}  // namespace quorient::bus::fastdds
