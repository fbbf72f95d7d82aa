#pragma once

#include "processes.hpp"
#include "quorient/system/system.hpp"

#include <cstdint>

namespace quorient::launch {

/// iceoryx's daemon, for systems that use it.
class Roudi {
public:
    /// Starts it where the system needs it and none runs. @returns whether it answers.
    bool start(const system::System& system, Processes& processes);

    /// @returns true once: the daemon is gone, or another one has taken its place, and with it what newcomers would share.
    bool lost();

private:
    std::uint64_t life_ = 0;
};

}  // namespace quorient::launch
