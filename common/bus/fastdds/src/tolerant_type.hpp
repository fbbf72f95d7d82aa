#pragma once

#include "version.hpp"

#include <fastcdr/exceptions/Exception.h>

namespace quorient::bus::fastdds {

/// A generated type whose decoder refuses invalid CDR. Fast DDS's own decoder throws on a wrong encapsulation, through the reader into the
/// caller that takes a sample: one damaged datagram would end the process.
template <class PubSubType>
class TolerantType final : public PubSubType {
public:
    bool deserialize(PayloadParameter payload, void* sample) override
    {
        try {
            return PubSubType::deserialize(payload, sample);
        } catch (const eprosima::fastcdr::exception::Exception&) {
            return false;
        }
    }
};

}  // namespace quorient::bus::fastdds
