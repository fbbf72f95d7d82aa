#pragma once

#include <cstddef>
#include <cstdint>

namespace quorient::bus::fastdds {

/// Whether a datagram is whole as RTPS frames it [RTPS 9.4]: the header, submessages that end where the datagram ends, and Fast DDS's own
/// statistics submessage (id 0x80) as Fast DDS itself writes it, last and of 56 bytes; inline QoS, and descriptions of participants and
/// endpoints, that end in their submessage and hold as many elements as they say; gaps of at most 65536 numbers and fragments of samples of
/// at most 64 KiB.
///
/// Why: Fast DDS 2.9.1 as packaged (statistics and assertions on) trusts such datagrams.
/// - A statistics submessage of another length aborts the process.
/// - Inline QoS that reaches beyond its submessage makes the payload size negative, and gigabytes are cleared.
/// - An endpoint that claims four thousand million data representations makes it allocate them.
/// - It stores the numbers of a gap one by one, and allocates a whole sample on its first fragment.
/// What is refused here never reaches its parser. A real writer's longer gap would be refused too; by the protocol its next heartbeat
/// repeats it (not tested: writers here keep far fewer samples).
bool is_sound_rtps(const std::uint8_t* data, std::size_t size);

}  // namespace quorient::bus::fastdds
