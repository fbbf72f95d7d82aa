#pragma once

#include "openssl.hpp"

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::security {

/// Seconds since 1970.
struct Validity {
    std::int64_t from_s = 0;
    std::int64_t until_s = 0;
};

/// A new key on the curve P-256, which both vendors accept.
Key make_key();

/// An authority: its certificate and its key.
struct Issuer {
    Certificate certificate;
    Key key;
};

/// @param signs_documents  true: it signs governance and permissions; false: it issues and revokes identities.
Issuer make_issuer(const std::string& common_name, const Validity& validity, bool signs_documents);

/// A certificate for `key`. Its subject is CN=common_name alone: the vendors disagree about longer ones.
Certificate issue(const Issuer& issuer, EVP_PKEY& key, const std::string& common_name, const Validity& validity);

/// @param serials  of the revoked certificates, as serial_of() writes them.
RevocationList revoke(const Issuer& issuer, const std::vector<std::string>& serials, const Validity& validity);

std::string common_name_of(const X509& certificate);
std::string serial_of(const X509& certificate);
Validity validity_of(const X509& certificate);

/// Why a certificate is not valid: another authority, outside its period, revoked. Empty if it is valid.
std::string refusal(X509& certificate, X509& authority, X509_CRL& revoked, std::int64_t now_s);

// PEM. Reading returns null if the text is something else.
std::string pem_of(EVP_PKEY& key);
std::string pem_of(X509& certificate);
std::string pem_of(X509_CRL& list);
Key key_from(const std::string& pem);
Certificate certificate_from(const std::string& pem);
RevocationList revocation_list_from(const std::string& pem);

}  // namespace quorient::security
