#pragma once

#include <string>

namespace quorient::bus {

/// Registers with iceoryx's daemon under a temporary name and leaves again. A daemon of another version does not answer; a daemon of
/// another user has memory that this process may not open. Cyclone DDS would wait 60 s for it, ignore SIGTERM, and then abort. A daemon in
/// another namespace of process ids would let processes destroy what they share, and block for good.
/// @returns why the daemon refuses this process and what to do; empty when it accepts it. Takes less than a second.
std::string iceoryx_refusal();

/// From now on a full memory pool fails that one write. iceoryx itself, as packaged, ends the process.
void survive_full_pools();

}  // namespace quorient::bus
