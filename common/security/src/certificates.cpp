#include "certificates.hpp"

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <ctime>

namespace quorient::security {

namespace {

constexpr long version_3 = 2;  // as the field counts
constexpr int serial_bits = 127;

struct OpenSslFree {
    void operator()(char* text) const { OPENSSL_free(text); }
};

void set_subject(X509_NAME* name, const std::string& common_name)
{
    const auto* text = reinterpret_cast<const unsigned char*>(common_name.data());
    must(X509_NAME_add_entry_by_NID(name, NID_commonName, MBSTRING_UTF8, text, static_cast<int>(common_name.size()), -1, 0) == 1,
         "common name");
}

/// Random, so that no two authorities and no two runs agree on one.
void set_serial(X509& certificate)
{
    const auto number = must(BigNumber{BN_new()}, "serial");
    must(BN_rand(number.get(), serial_bits, BN_RAND_TOP_ONE, BN_RAND_BOTTOM_ANY) == 1, "serial");
    must(BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(&certificate)) != nullptr, "serial");
}

void add_extension(X509& certificate, X509& issuer, int kind, const char* value)
{
    X509V3_CTX context;
    X509V3_set_ctx(&context, &issuer, &certificate, nullptr, nullptr, 0);
    using Extension = std::unique_ptr<X509_EXTENSION, FreeWith<X509_EXTENSION_free>>;
    const auto extension = must(Extension{X509V3_EXT_conf_nid(nullptr, &context, kind, value)}, value);
    must(X509_add_ext(&certificate, extension.get(), -1) == 1, value);
}

Certificate blank(EVP_PKEY& key, const std::string& common_name, const Validity& validity)
{
    auto certificate = must(Certificate{X509_new()}, "certificate");
    must(X509_set_version(certificate.get(), version_3) == 1, "version");
    set_serial(*certificate);
    must(ASN1_TIME_set(X509_getm_notBefore(certificate.get()), validity.from_s) != nullptr, "validity");
    must(ASN1_TIME_set(X509_getm_notAfter(certificate.get()), validity.until_s) != nullptr, "validity");
    must(X509_set_pubkey(certificate.get(), &key) == 1, "key");
    set_subject(X509_get_subject_name(certificate.get()), common_name);
    return certificate;
}

std::int64_t seconds(const ASN1_TIME& time)
{
    std::tm parts{};
    must(ASN1_TIME_to_tm(&time, &parts) == 1, "time");
    return ::timegm(&parts);
}

std::string hexadecimal(const ASN1_INTEGER& number)
{
    const auto value = must(BigNumber{ASN1_INTEGER_to_BN(&number, nullptr)}, "serial");
    const std::unique_ptr<char, OpenSslFree> text{BN_bn2hex(value.get())};
    must(text != nullptr, "serial");
    return text.get();
}

}  // namespace

Key make_key()
{
    return must(Key{EVP_EC_gen("P-256")}, "key");
}

Issuer make_issuer(const std::string& common_name, const Validity& validity, bool signs_documents)
{
    auto key = make_key();
    auto certificate = blank(*key, common_name, validity);
    must(X509_set_issuer_name(certificate.get(), X509_get_subject_name(certificate.get())) == 1, "issuer");
    add_extension(*certificate, *certificate, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
    add_extension(*certificate, *certificate, NID_key_usage,
                  signs_documents ? "critical,digitalSignature,keyCertSign" : "critical,keyCertSign,cRLSign");
    add_extension(*certificate, *certificate, NID_subject_key_identifier, "hash");
    must(X509_sign(certificate.get(), key.get(), EVP_sha256()) != 0, "signature");
    return {std::move(certificate), std::move(key)};
}

Certificate issue(const Issuer& issuer, EVP_PKEY& key, const std::string& common_name, const Validity& validity)
{
    auto certificate = blank(key, common_name, validity);
    must(X509_set_issuer_name(certificate.get(), X509_get_subject_name(issuer.certificate.get())) == 1, "issuer");
    add_extension(*certificate, *issuer.certificate, NID_basic_constraints, "critical,CA:FALSE");
    add_extension(*certificate, *issuer.certificate, NID_key_usage, "critical,digitalSignature,keyAgreement");
    add_extension(*certificate, *issuer.certificate, NID_authority_key_identifier, "keyid");
    must(X509_sign(certificate.get(), issuer.key.get(), EVP_sha256()) != 0, "signature");
    return certificate;
}

RevocationList revoke(const Issuer& issuer, const std::vector<std::string>& serials, const Validity& validity)
{
    auto list = must(RevocationList{X509_CRL_new()}, "revocation list");
    must(X509_CRL_set_version(list.get(), 1) == 1, "version");
    must(X509_CRL_set_issuer_name(list.get(), X509_get_subject_name(issuer.certificate.get())) == 1, "issuer");
    using Time = std::unique_ptr<ASN1_TIME, FreeWith<ASN1_TIME_free>>;
    const auto from = must(Time{ASN1_TIME_set(nullptr, validity.from_s)}, "time");
    const auto until = must(Time{ASN1_TIME_set(nullptr, validity.until_s)}, "time");
    must(X509_CRL_set1_lastUpdate(list.get(), from.get()) == 1 && X509_CRL_set1_nextUpdate(list.get(), until.get()) == 1, "time");
    for (const auto& serial : serials) {
        BIGNUM* parsed = nullptr;
        must(BN_hex2bn(&parsed, serial.c_str()) != 0, "serial");
        const BigNumber number{parsed};
        using Integer = std::unique_ptr<ASN1_INTEGER, FreeWith<ASN1_INTEGER_free>>;
        const auto integer = must(Integer{BN_to_ASN1_INTEGER(number.get(), nullptr)}, "serial");
        using Revoked = std::unique_ptr<X509_REVOKED, FreeWith<X509_REVOKED_free>>;
        auto entry = must(Revoked{X509_REVOKED_new()}, "entry");
        must(X509_REVOKED_set_serialNumber(entry.get(), integer.get()) == 1, "serial");
        must(X509_REVOKED_set_revocationDate(entry.get(), from.get()) == 1, "time");
        must(X509_CRL_add0_revoked(list.get(), entry.get()) == 1, "entry");
        (void)entry.release();  // the list's
    }
    must(X509_CRL_sort(list.get()) == 1, "order");
    must(X509_CRL_sign(list.get(), issuer.key.get(), EVP_sha256()) != 0, "signature");
    return list;
}

std::string common_name_of(const X509& certificate)
{
    auto* subject = X509_get_subject_name(&certificate);
    const int place = X509_NAME_get_index_by_NID(subject, NID_commonName, -1);
    if (place < 0) return {};
    const auto* text = X509_NAME_ENTRY_get_data(X509_NAME_get_entry(subject, place));
    return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)), static_cast<std::size_t>(ASN1_STRING_length(text))};
}

std::string serial_of(const X509& certificate)
{
    return hexadecimal(*X509_get0_serialNumber(&certificate));
}

Validity validity_of(const X509& certificate)
{
    return {seconds(*X509_get0_notBefore(&certificate)), seconds(*X509_get0_notAfter(&certificate))};
}

std::string refusal(X509& certificate, X509& authority, X509_CRL& revoked, std::int64_t now_s)
{
    const auto store = must(Store{X509_STORE_new()}, "store");
    must(X509_STORE_add_cert(store.get(), &authority) == 1 && X509_STORE_add_crl(store.get(), &revoked) == 1, "store");
    const auto context = must(StoreContext{X509_STORE_CTX_new()}, "context");
    must(X509_STORE_CTX_init(context.get(), store.get(), &certificate, nullptr) == 1, "context");
    X509_STORE_CTX_set_flags(context.get(), X509_V_FLAG_CRL_CHECK);
    X509_STORE_CTX_set_time(context.get(), 0, now_s);
    if (X509_verify_cert(context.get()) == 1) return {};
    ERR_clear_error();
    const int error = X509_STORE_CTX_get_error(context.get());
    const bool other_authority = error == X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY || error == X509_V_ERR_CERT_SIGNATURE_FAILURE;
    return other_authority ? "it is from another authority than identity_ca.pem" : X509_verify_cert_error_string(error);
}

std::string pem_of(EVP_PKEY& key)
{
    const auto stream = memory();
    must(PEM_write_bio_PKCS8PrivateKey(stream.get(), &key, nullptr, nullptr, 0, nullptr, nullptr) == 1, "key");
    return content_of(*stream);
}

std::string pem_of(X509& certificate)
{
    const auto stream = memory();
    must(PEM_write_bio_X509(stream.get(), &certificate) == 1, "certificate");
    return content_of(*stream);
}

std::string pem_of(X509_CRL& list)
{
    const auto stream = memory();
    must(PEM_write_bio_X509_CRL(stream.get(), &list) == 1, "revocation list");
    return content_of(*stream);
}

Key key_from(const std::string& pem)
{
    const auto no_question = [](char*, int, int, void*) { return -1; };  // a key with a password is refused: no one is there to type it
    Key key{PEM_read_bio_PrivateKey(memory(pem).get(), nullptr, no_question, nullptr)};
    ERR_clear_error();
    return key;
}

Certificate certificate_from(const std::string& pem)
{
    Certificate certificate{PEM_read_bio_X509(memory(pem).get(), nullptr, nullptr, nullptr)};
    ERR_clear_error();
    return certificate;
}

RevocationList revocation_list_from(const std::string& pem)
{
    RevocationList list{PEM_read_bio_X509_CRL(memory(pem).get(), nullptr, nullptr, nullptr)};
    ERR_clear_error();
    return list;
}

}  // namespace quorient::security
