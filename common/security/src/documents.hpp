#pragma once

#include "certificates.hpp"
#include "quorient/bus/security.hpp"
#include "quorient/security/access.hpp"
#include "quorient/security/identity.hpp"

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::security {

// The two documents that DDS Security signs [DDS Security 1.1, 9.4.1].

std::string governance_document(const Governance& governance);
tl::expected<Governance, std::string> read_governance(const std::string& document);

/// What the holders of some certificates may publish and subscribe in one domain.
struct Permissions {
    std::uint32_t domain = 0;
    std::vector<std::string> common_names;
    Access access;
    Validity validity;
};
std::string permissions_document(const Permissions& permissions);

/// Reads the first grant for this common name. @returns an error if there is none, or the document has another form.
tl::expected<Permissions, std::string> read_permissions(const std::string& document, const std::string& common_name);

// S/MIME in the form that both vendors accept: text/plain, detached.

std::string sign(const std::string& document, const Issuer& issuer);

/// @returns the document that `authority` signed; or an error.
tl::expected<std::string, std::string> verified(const std::string& signed_document, X509& authority);

}  // namespace quorient::security
