#pragma once

#include <cstdint>

namespace quorient::bus {

/// From where a subscription wants its samples.
enum class Reach : std::uint8_t {
    anywhere,
    process,  ///< Whoever writes them runs in this process. A bus that is not composed knows no difference.
};

/// Whether a sample of a subscription ends the bus's wait.
enum class Wake : std::uint8_t {
    at_once,
    with_others,  ///< No: it is there when a sample of another topic ends it, or the time. A composed bus and the local one know no difference.
};

struct ReaderOptions {
    Reach reach = Reach::anywhere;
    Wake wake = Wake::at_once;
};

}  // namespace quorient::bus
