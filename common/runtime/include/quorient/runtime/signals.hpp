#pragma once

#include <atomic>

namespace quorient::runtime {

/// Installs handlers for SIGTERM and SIGINT once; they store this flag and do nothing else.
const std::atomic<bool>& termination_requested();

/// Of a process whose work is done: from here on it may take so long to leave the bus, then it ends without, and says so. Fast DDS 2.9.1
/// has been seen not to come back from leaving (one of 56 cells of the kill matrix).
/// @returns the exit code, for main to return.
int ends_within(unsigned patience_s, int exit_code);

}  // namespace quorient::runtime
