#include "quorient/runtime/realtime.hpp"

#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <cerrno>
#include <cstring>

namespace quorient::runtime {

namespace {

void warn_if_refused(int result, const char* what)
{
    if (result != 0) spdlog::warn("{} refused ({}): goes on without", what, std::strerror(errno));
}

}  // namespace

void ask_for_realtime(const RealtimeSettings& settings)
{
    if (settings.priority > 0) {
        sched_param parameters{};
        parameters.sched_priority = settings.priority;
        warn_if_refused(::sched_setscheduler(0, SCHED_FIFO, &parameters), "real-time priority");
    }
    if (settings.lock_memory) warn_if_refused(::mlockall(MCL_CURRENT | MCL_FUTURE), "memory lock");
    if (!settings.processors.empty()) {
        cpu_set_t allowed;
        CPU_ZERO(&allowed);
        for (const auto processor : settings.processors) CPU_SET(processor, &allowed);
        warn_if_refused(::sched_setaffinity(0, sizeof allowed, &allowed), "processor affinity");
    }
}

}  // namespace quorient::runtime
