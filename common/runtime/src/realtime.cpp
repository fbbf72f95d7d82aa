#include "quorient/runtime/realtime.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <cerrno>
#include <cstring>
#include <string>

namespace quorient::runtime {

void ask_for_realtime(const RealtimeSettings& settings)
{
    std::vector<std::string> refused;
    const auto asked = [&](int result, std::string_view what) {
        if (result != 0) refused.push_back(fmt::format("{} ({})", what, std::strerror(errno)));
    };
    if (settings.priority > 0) {
        sched_param parameters{};
        parameters.sched_priority = static_cast<int>(settings.priority);
        asked(::sched_setscheduler(0, SCHED_FIFO, &parameters), "real-time priority");
    }
    if (settings.lock_memory) asked(::mlockall(MCL_CURRENT | MCL_FUTURE), "memory lock");
    if (!settings.processors.empty()) {
        cpu_set_t allowed;
        CPU_ZERO(&allowed);
        for (const auto processor : settings.processors) CPU_SET(processor, &allowed);
        asked(::sched_setaffinity(0, sizeof allowed, &allowed), "processor affinity");
    }
    if (!refused.empty()) spdlog::warn("refused: {}; goes on without", fmt::join(refused, ", "));
}

}  // namespace quorient::runtime
