#pragma once

#include <cstdint>

namespace quorient::bus {

/// The part of DDS's quality of service that Quorient uses. Each topic's values and their reasons: idl/README.md.
struct Qos {
    bool reliable = true;
    bool transient_local = false;  ///< a late joiner gets the history at once
    std::int32_t depth = 64;       ///< KEEP_LAST
    bool latched = false;          ///< rare samples that every late joiner needs: never by iceoryx, whose history may not arrive
    bool exclusive = false;        ///< EXCLUSIVE ownership with MANUAL_BY_TOPIC liveliness: fails over between writers
};

/// What is known only when a system is put together.
struct WriterOptions {
    std::int32_t strength = 0;  ///< ownership strength of an exclusive writer
    double lease_s = 0.05;      ///< liveliness lease of an exclusive writer, as the contract states it
};

/// The lease that goes on the wire [s]: a little shorter, since a lease travels as a binary fraction. A reader that asks for exactly the stated
/// lease is then accepted, whichever way either vendor rounds.
constexpr double offered_lease_s(double lease_s)
{
    constexpr double margin_s = 1e-4;
    return lease_s - margin_s;
}

}  // namespace quorient::bus
