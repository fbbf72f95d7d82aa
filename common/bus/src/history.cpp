#include "quorient/bus/history.hpp"

#include "quorient/bus/interfaces.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::bus {

std::int32_t kept_samples(const Qos& qos, const WriterOptions& options, const Settings& settings)
{
    if (!qos.exclusive || !is_loopback(settings.interface)) return qos.depth;
    constexpr double rounding = 1e-6;  // 50 ms of 5 ms are ten samples
    const double interval_s = 2 * settings.heartbeat_s;
    return static_cast<std::int32_t>(std::clamp(std::floor(options.lease_s / interval_s + rounding), 1.0, static_cast<double>(qos.depth)));
}

}  // namespace quorient::bus
