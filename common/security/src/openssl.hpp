#pragma once

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <memory>
#include <string>

namespace quorient::security {

/// Deleter for OpenSSL's objects.
template <auto Free>
struct FreeWith {
    template <class Object>
    void operator()(Object* object) const
    {
        Free(object);
    }
};
using Bio = std::unique_ptr<BIO, FreeWith<BIO_free_all>>;
using Key = std::unique_ptr<EVP_PKEY, FreeWith<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, FreeWith<X509_free>>;
using RevocationList = std::unique_ptr<X509_CRL, FreeWith<X509_CRL_free>>;
using SignedDocument = std::unique_ptr<PKCS7, FreeWith<PKCS7_free>>;
using Store = std::unique_ptr<X509_STORE, FreeWith<X509_STORE_free>>;
using StoreContext = std::unique_ptr<X509_STORE_CTX, FreeWith<X509_STORE_CTX_free>>;
using BigNumber = std::unique_ptr<BIGNUM, FreeWith<BN_free>>;

/// For calls that fail only without memory or randomness. @throws std::runtime_error with OpenSSL's reason.
void must(bool done, const char* what);

template <class Owner>
Owner must(Owner owner, const char* what)
{
    must(owner != nullptr, what);
    return owner;
}

/// A stream in memory: empty, or with this content.
Bio memory();
Bio memory(const std::string& content);

/// The whole content of a stream in memory.
std::string content_of(BIO& stream);

}  // namespace quorient::security
