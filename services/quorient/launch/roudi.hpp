#pragma once

#include "processes.hpp"
#include "quorient/system/system.hpp"

#include <cstdint>
#include <string>

namespace quorient::launch {

/// iceoryx's daemon, for systems that use it.
class Roudi {
public:
    /// Starts it where the system needs it and none runs. @returns why it does not answer; empty when it does, or is not needed.
    std::string start(const system::System& system, Processes& processes);

    /// @returns true once: the daemon is gone, or another one has taken its place, and with it what newcomers would share.
    bool lost();

private:
    std::uint64_t life_ = 0;
};

}  // namespace quorient::launch
