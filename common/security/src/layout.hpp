#pragma once

#include "quorient/messages/codes.hpp"

#include <filesystem>
#include <string>

namespace quorient::security {

/// The paths in a directory of keys.
struct Layout {
    std::filesystem::path directory;

    std::filesystem::path authority() const { return directory / "authority"; }
    std::filesystem::path identity_ca_key() const { return authority() / "identity_ca.key"; }
    std::filesystem::path permissions_ca_key() const { return authority() / "permissions_ca.key"; }
    std::filesystem::path books() const { return authority() / "identities.json"; }

    std::filesystem::path shared() const { return directory / "shared"; }
    std::filesystem::path identity_ca() const { return shared() / "identity_ca.pem"; }
    std::filesystem::path permissions_ca() const { return shared() / "permissions_ca.pem"; }
    std::filesystem::path governance() const { return shared() / "governance.p7s"; }
    std::filesystem::path revoked() const { return shared() / "revoked.pem"; }

    std::filesystem::path of(const std::string& name) const { return directory / name; }
    std::filesystem::path key(const std::string& name) const { return of(name) / "key.pem"; }
    std::filesystem::path certificate(const std::string& name, Vendor vendor) const
    {
        return of(name) / (vendor == Vendor::fastdds ? "fastdds.pem" : "cyclonedds.pem");
    }
    std::filesystem::path permissions(const std::string& name) const { return of(name) / "permissions.p7s"; }
};

}  // namespace quorient::security
