#pragma once

#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <memory>

namespace quorient::bus::fastdds {

/// A transport that lets only sound RTPS datagrams in (rtps_guard.hpp), around another one.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> guarded(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> transport);

}  // namespace quorient::bus::fastdds
