#pragma once

#include <cstdint>
#include <vector>

namespace quorient::runtime {

struct RealtimeSettings {
    unsigned priority = 0;  ///< SCHED_FIFO priority 1 to 99; 0 = ordinary scheduling
    bool lock_memory = false;
    std::vector<std::uint32_t> processors;  ///< allowed; empty = all
};

/// Asks the kernel for what is set. What it refuses is named in one warning, and the service goes on without.
void ask_for_realtime(const RealtimeSettings& settings);

}  // namespace quorient::runtime
