#pragma once

#include "quorient/bus/security.hpp"
#include "quorient/security/access.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::security {

/// A node that needs an identity.
struct Member {
    std::string name;  ///< the process in the system file, and its folder
    Role role = Role::consumer;
    Access access;
};

/// A certificate that has been issued.
struct IssuedCertificate {
    std::string common_name;
    std::string serial;  ///< hexadecimal
    std::int64_t expires_s = 0;
};

/// A member and its newest certificates, one for each vendor.
struct IssuedIdentity {
    Member member;
    std::vector<IssuedCertificate> certificates;
    bool revoked = false;
};

/// Issues the identities of one system and records them, in one directory:
///
///     authority/    keys of the two authorities, and identities.json; stays on the host where keys are made
///     shared/       for every host: certificates of the authorities, governance.p7s, revoked.pem
///     NAME/         for NAME alone: key.pem (mode 0600), a certificate for either vendor, permissions.p7s
///
/// Identities and permissions have separate authorities. Fast DDS lets any certificate of the permissions authority sign permissions.
/// With a single authority every member could sign its own.
///
/// An error names the file. Repeating the call completes what a failed call began.
class Authority {
public:
    /// Opens the authority of a directory, or makes one.
    /// @param now_s  seconds since 1970; certificates are valid from a day earlier, since the clocks of hosts differ.
    static tl::expected<Authority, std::string> open_or_make(const std::filesystem::path& directory, std::int64_t now_s);

    /// @returns an error if the directory has none.
    static tl::expected<Authority, std::string> open(const std::filesystem::path& directory);

    Authority(Authority&&) noexcept;
    Authority& operator=(Authority&&) noexcept;
    ~Authority();

    std::uint32_t domain() const;
    bus::SecurityLevel level() const;
    const std::vector<IssuedIdentity>& identities() const;
    const IssuedIdentity* find(const std::string& name) const;

    /// Writes the governance of the domain. If the domain has changed, signs all permissions again.
    tl::expected<void, std::string> govern(std::uint32_t domain, bus::SecurityLevel level, std::int64_t now_s);

    /// Makes a new key, new certificates and permissions. Earlier certificates of the name stay valid until they expire or are revoked.
    tl::expected<void, std::string> issue(const Member& member, std::int64_t now_s, std::int64_t lifetime_s);

    /// Signs other permissions for an existing identity.
    tl::expected<void, std::string> permit(const Member& member, std::int64_t now_s);

    /// Puts every certificate that this name ever had on the revocation list. Processes read the list when they start.
    tl::expected<void, std::string> revoke(const std::string& name, std::int64_t now_s);

private:
    struct Books;
    explicit Authority(std::unique_ptr<Books> books);

    std::unique_ptr<Books> books_;
};

}  // namespace quorient::security
