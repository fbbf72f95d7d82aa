#pragma once

#include "version.hpp"

#include <atomic>
#include <memory>

namespace quorient::bus::fastdds {

/// Whether the process already receives answers.
using Listening = std::shared_ptr<std::atomic<bool>>;

/// A transport around another one. Inwards it passes only sound RTPS datagrams (rtps_guard.hpp), with ACKNACKs in the form that Fast DDS
/// expects (foreign_acknacks.hpp). Outwards it passes nothing before the process listens. Fast DDS 2.9.1 announces itself a moment too
/// early: the immediate answer of a Cyclone DDS node is then lost, and its next one comes 1 s later.
///
/// Datagrams of discovery pass one at a time, also where they arrive by multicast and by unicast at once. Fast DDS 2.9.1 may otherwise never
/// reply to the handshake of a node that announces itself to both (common/bus/README.md). Received messages of a handshake wait (handshake.hpp).
std::shared_ptr<rtps::TransportDescriptorInterface> guarded(
    std::shared_ptr<rtps::TransportDescriptorInterface> transport, Listening listening);

}  // namespace quorient::bus::fastdds
