// What the secured pairs' two processes share.
#pragma once

#include "quorient/bus/bus.hpp"
#include "quorient/security/identity.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace quorient::security {

/// @throws bus::Error where the identity is not there, or the vendor refuses it.
inline std::unique_ptr<bus::Bus> join(const std::filesystem::path& keys, const std::string& name, Vendor vendor, std::uint32_t domain,
                                      bus::SecurityLevel level)
{
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const auto identity = find_identity(keys, {name, vendor, domain, level}, std::chrono::duration_cast<std::chrono::seconds>(now).count());
    if (!identity) throw bus::Error(identity.error().front());
    bus::Settings settings;
    settings.vendor = vendor;
    settings.domain = domain;
    settings.security = identity->files;
    settings.participant = identity->files.common_name;
    auto opened = bus::open(settings);
    if (!opened) throw bus::Error(opened.error());
    return std::move(*opened);
}

}  // namespace quorient::security
