#pragma once

#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <atomic>
#include <memory>

namespace quorient::bus::fastdds {

/// Whether the process can hear answers.
using Listening = std::shared_ptr<std::atomic<bool>>;

/// A transport around another one, that lets only sound RTPS datagrams in (rtps_guard.hpp), with acknowledgements as Fast DDS understands
/// them (foreign_acknacks.hpp), and nothing out before the process listens: Fast DDS 2.9.1 announces itself a moment before it does, the
/// answer of a Cyclone DDS node comes at once and is lost, and its next one comes 1 s later.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> guarded(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> transport, Listening listening);

}  // namespace quorient::bus::fastdds
