#include "quorient/bus/bus.hpp"
#include "quorient/bus/cyclonedds_bus.hpp"
#include "quorient/bus/fastdds_bus.hpp"
#include "quorient/bus/local_bus.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace quorient::bus {

tl::expected<std::unique_ptr<Bus>, std::string> open(const Settings& settings)
{
    if (const auto found = problems(settings); !found.empty()) return tl::make_unexpected(fmt::format("{}", fmt::join(found, "\n")));
    switch (settings.vendor) {
        case Vendor::local:
            return LocalHub{}.open();
        case Vendor::fastdds:
            return open_fastdds(settings);
        case Vendor::cyclonedds:
            return open_cyclonedds(settings);
        case Vendor::unknown:
            break;
    }
    return tl::make_unexpected("no DDS vendor chosen: fastdds, cyclonedds or local");
}

}  // namespace quorient::bus
