#include "quorient/runtime/signals.hpp"

#include <csignal>

namespace quorient::runtime {

namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void request(int)
{
    requested.store(true);
}

}  // namespace

const std::atomic<bool>& termination_requested()
{
    struct sigaction action {};
    action.sa_handler = request;
    sigemptyset(&action.sa_mask);
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
    return requested;
}

}  // namespace quorient::runtime
