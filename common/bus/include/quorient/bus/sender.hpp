#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace quorient::bus {

/// The first twelve octets of a GUID, common to a participant and all its endpoints [RTPS 9.3.1.5].
using GuidPrefix = std::array<std::uint8_t, 12>;

/// The participant that wrote a sample.
struct Sender {
    std::string name;            ///< as the participant announces it; empty if it has none or has left
    std::string guid{};          ///< its prefix, hexadecimal
    bool authenticated = false;  ///< the certificate confirms the name
};

/// @param secured  the participant was authenticated by DDS Security, so its GUID is bound to its certificate.
Sender make_sender(const std::string& name, const GuidPrefix& guid, bool secured);

}  // namespace quorient::bus
