#pragma once

#include <cstddef>
#include <cstdint>

namespace quorient::bus::fastdds {

/// Whether a datagram is whole as RTPS frames it [RTPS 9.4]: the header, submessages that end where the datagram ends, and Fast DDS's own
/// statistics submessage (id 0x80) as Fast DDS itself writes it, last and of 56 bytes; inline QoS, and descriptions of participants and
/// endpoints, that end in their submessage and hold as many elements as they say; gaps of at most 65536 numbers and fragments of samples of
/// at most 64 KiB.
///
/// Why: Fast DDS 2.9.1 as packaged (statistics and assertions on) aborts the process on a datagram whose statistics submessage has
/// another length; where inline QoS reaches beyond its submessage it takes the size of the payload behind it for gigabytes and clears
/// them; where an endpoint claims four thousand million data representations it makes room for them; it keeps the numbers of a gap one by
/// one, and takes the memory for a whole sample on its first fragment, whoever sent them. What is refused here never reaches its parser. A
/// true writer's longer gap would be refused too; by the protocol its next heartbeat says the same (not tried: writers here keep far fewer
/// samples).
bool is_sound_rtps(const std::uint8_t* data, std::size_t size);

}  // namespace quorient::bus::fastdds
