#pragma once

#include "quorient/bus/bus.hpp"

#include <unistd.h>
#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>

namespace quorient::bus {

/// A bus of this vendor on loopback, in a domain of this process. Throws where it cannot be opened.
inline std::unique_ptr<Bus> open_on_loopback(Vendor vendor)
{
    Settings settings;
    settings.vendor = vendor;
    settings.domain = 100 + static_cast<std::uint32_t>(::getpid() % 100);
    settings.participant = "test";
    auto bus = open(settings);
    if (!bus) throw Error(bus.error());
    return std::move(*bus);
}

/// Polls until the condition holds, for 20 s at most; waits on the bus, not on the clock.
template <class Condition>
bool eventually(Bus& bus, Condition condition)
{
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{20};
    while (!condition()) {
        if (std::chrono::steady_clock::now() > deadline) return false;
        bus.wait(5'000'000);
    }
    return true;
}

}  // namespace quorient::bus
