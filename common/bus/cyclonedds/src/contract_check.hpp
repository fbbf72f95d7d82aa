#pragma once

#include "quorient/bus/refusals.hpp"

#include <dds/dds.h>
#include <array>
#include <cstddef>

namespace quorient::bus::cyclonedds {

/// Whether a reader accepts a writer's samples: not those of a participant that announces another wire contract. Cyclone DDS 0.10 cannot
/// ignore a participant, so each reader asks once for each writer and keeps the answer.
class ContractCheck {
public:
    /// @param refusals  receives a text for each participant that is refused; must outlive this.
    ContractCheck(dds_entity_t reader, Refusals& refusals) : reader_(reader), refusals_(refusals) {}

    /// @param writer  publication handle of a sample.
    bool accepts(dds_instance_handle_t writer);

private:
    struct Answer {
        dds_instance_handle_t writer = 0;
        bool accepted = true;
    };

    bool ask(dds_instance_handle_t writer);

    dds_entity_t reader_;
    Refusals& refusals_;
    std::array<Answer, 16> answers_{};  ///< a ring: of more writers than this, the oldest is asked for again
    std::size_t next_ = 0;
};

}  // namespace quorient::bus::cyclonedds
