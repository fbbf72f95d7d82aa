#pragma once

#include "quorient/bus/refusals.hpp"

#include <dds/dds.h>
#include <unordered_map>

namespace quorient::bus::cyclonedds {

/// Whether a reader accepts a writer's samples: not those of a participant that announces another wire contract. Cyclone DDS 0.10 cannot
/// ignore a participant, so each reader asks once for each writer and keeps the answer; handles are not used again. A writer that has left
/// before its first sample was taken is accepted: nobody knows any more what it announced, and the order of a tool that ends must not be lost.
class ContractCheck {
public:
    /// @param refusals  receives a text for each participant that is refused; must outlive this.
    ContractCheck(dds_entity_t reader, Refusals& refusals) : reader_(reader), refusals_(refusals) {}

    /// @param writer  publication handle of a sample.
    bool accepts(dds_instance_handle_t writer);

private:
    bool ask(dds_instance_handle_t writer);

    dds_entity_t reader_;
    Refusals& refusals_;
    std::unordered_map<dds_instance_handle_t, bool> accepted_;
};

}  // namespace quorient::bus::cyclonedds
