#pragma once

#include <cstddef>
#include <cstdint>

namespace quorient::bus::fastdds {

/// Whether a datagram is whole as RTPS frames it [RTPS 9.4]: the header, submessages that end where the datagram ends, and Fast DDS's own
/// statistics submessage (id 0x80) as Fast DDS itself writes it, last and of 56 bytes.
///
/// Why: Fast DDS 2.9.1 as packaged (statistics and assertions on) aborts the process on a datagram whose statistics submessage has
/// another length, whoever sent it. What is refused here never reaches its parser.
bool is_sound_rtps(const std::uint8_t* data, std::size_t size);

}  // namespace quorient::bus::fastdds
