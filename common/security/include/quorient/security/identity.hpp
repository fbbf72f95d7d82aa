#pragma once

#include "quorient/bus/security.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::security {

/// The process that wants to join.
struct Joining {
    std::string name;
    Vendor vendor = Vendor::cyclonedds;
    std::uint32_t domain = 0;
    bus::SecurityLevel level = bus::SecurityLevel::encrypt;
};

/// The files that a process joins with.
struct Identity {
    bus::SecurityFiles files;
    std::int64_t expires_s = 0;  ///< seconds since 1970
};

/// Finds the files of one process in a directory that Authority made, and checks each before a vendor reads it: readable, signed by the
/// directory's authorities, valid now, not revoked, for this name, vendor, domain and level; the key for its owner (and group) alone.
/// @param now_s  seconds since 1970
/// @returns all problems, each with the file and what to do.
tl::expected<Identity, std::vector<std::string>> find_identity(const std::filesystem::path& directory, const Joining& joining,
                                                               std::int64_t now_s);

/// How the topics of a domain are protected.
struct Governance {
    std::uint32_t domain = 0;
    bus::SecurityLevel level = bus::SecurityLevel::encrypt;
};

/// Reads the governance of a directory. @returns an error with the file and what to do.
tl::expected<Governance, std::string> find_governance(const std::filesystem::path& directory);

}  // namespace quorient::security
