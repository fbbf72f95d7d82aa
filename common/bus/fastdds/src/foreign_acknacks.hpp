#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace quorient::bus::fastdds {

/// A datagram of another vendor, with those of its acknowledgements [RTPS 9.4.5.3] that are for built-in writers told as Fast DDS
/// understands them: counted from 1, and one that has heard nothing yet (base 1, nothing asked for, an answer wanted) with base 0.
/// @param data  a datagram that `is_sound_rtps`
/// @returns nothing where it can go on as it is.
///
/// Why: Cyclone DDS answers no heartbeat of a node that it does not know yet. Once it knows it, it asks for another, with count 0. Fast DDS
/// 2.9.1 takes only counts above 0, and answers at once only to base 0; its own next heartbeat comes up to 1 s later. Until then neither
/// knows the endpoints of the other side, and a standby does not hear whom it stands by for.
std::optional<std::vector<std::uint8_t>> with_understood_acknacks(const std::uint8_t* data, std::size_t size);

}  // namespace quorient::bus::fastdds
