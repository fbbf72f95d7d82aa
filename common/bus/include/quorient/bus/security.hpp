#pragma once

#include "quorient/messages/codes.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace quorient::bus {

/// How DDS Security protects every topic. At `sign` and `encrypt` participants without a certificate are ignored.
enum class SecurityLevel : std::uint8_t {
    none,     ///< plain DDS
    sign,     ///< readable on the wire, cannot be forged
    encrypt,  ///< neither readable nor forgeable
};

/// @returns an error that lists the words, e.g. for "encrypted".
tl::expected<SecurityLevel, std::string> security_level_from(std::string_view word);
std::string_view to_string(SecurityLevel level);

/// The files that one participant joins with. common/security makes and checks them; a vendor only reads them.
struct SecurityFiles {
    std::string common_name;     ///< CN of the certificate's subject
    std::string identity_ca;     ///< certificate of the authority that issues identities
    std::string certificate;     ///< this participant's, for its vendor
    std::string private_key;
    std::string permissions_ca;  ///< certificate of the authority that signs the two documents below
    std::string governance;      ///< which topics are protected, and how
    std::string permissions;     ///< which topics this participant may publish and subscribe
    std::string revoked;         ///< certificate revocation list
};

/// The first 48 bits of the GUID of a participant whose certificate has this common name and no other part in its subject
/// [DDS Security 1.1, 9.3.3]: a set bit, then 47 bits of the subject's SHA-256. Either vendor checks them against the certificate, so
/// a participant cannot take another's name.
std::array<std::uint8_t, 6> guid_start(const std::string& common_name);

/// Whether a participant of this vendor completes the handshake with participants of both vendors under this common name. The lower GUID
/// initiates; Cyclone DDS 0.10 refuses the request of a Fast DDS 2.9 initiator, so every Cyclone DDS participant needs the lower GUID.
bool suits(Vendor vendor, const std::string& common_name);

}  // namespace quorient::bus
