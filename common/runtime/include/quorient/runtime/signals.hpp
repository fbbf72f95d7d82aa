#pragma once

#include <atomic>

namespace quorient::runtime {

/// Installs handlers for SIGTERM and SIGINT once; they store this flag and do nothing else.
const std::atomic<bool>& termination_requested();

/// Watchdog for shutdown: ends the process with this exit code, and says so, if leaving the bus takes longer than this.
/// Fast DDS 2.9.1 may not return from leaving.
void leave_within(unsigned patience_s, int exit_code);

}  // namespace quorient::runtime
