#pragma once

#include <atomic>

namespace quorient::runtime {

/// Installs handlers for SIGTERM and SIGINT once; they store this flag and do nothing else.
const std::atomic<bool>& termination_requested();

}  // namespace quorient::runtime
