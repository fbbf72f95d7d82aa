#pragma once

#include <string>

namespace quorient::bus {

/// Registers with iceoryx's daemon under a name for this question and leaves again. A daemon of another version answers nothing, one of
/// another user has memory that this process may not open; Cyclone DDS would wait 60 s for it, deaf to SIGTERM, and then abort.
/// @returns why it does not take this process in and what to do; empty when it does. Takes less than a second.
std::string iceoryx_refusal();

/// From now on a memory pool that has no room for a sample fails that one write. iceoryx itself, as packaged, ends the process.
void survive_full_pools();

}  // namespace quorient::bus
