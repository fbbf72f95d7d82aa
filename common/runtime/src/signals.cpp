#include "quorient/runtime/signals.hpp"

#include <unistd.h>
#include <csignal>
#include <string_view>

namespace quorient::runtime {

namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void request(int)
{
    requested.store(true);
}

std::atomic<int> overdue_exit_code{0};

void end_overdue(int)
{
    constexpr std::string_view text = "the bus could not be left in time: this process ends without\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    ::_exit(overdue_exit_code);
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

void leave_within(unsigned patience_s, int exit_code)
{
    overdue_exit_code = exit_code;
    struct sigaction action {};
    action.sa_handler = end_overdue;
    sigemptyset(&action.sa_mask);
    sigaction(SIGALRM, &action, nullptr);
    ::alarm(patience_s);
}

}  // namespace quorient::runtime
