#pragma once

#include <cstdint>

namespace quorient::bus {

/// From where a subscription wants its samples.
enum class Reach : std::uint8_t {
    anywhere,
    process,  ///< Whoever writes them runs in this process. A bus that is not composed knows no difference.
};

}  // namespace quorient::bus
