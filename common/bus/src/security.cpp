#include "quorient/bus/security.hpp"

#include "quorient/bus/sender.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>
#include <openssl/x509.h>
#include <algorithm>
#include <memory>
#include <new>
#include <utility>

namespace quorient::bus {

namespace {

constexpr std::array levels{std::pair{SecurityLevel::none, "none"}, std::pair{SecurityLevel::sign, "sign"},
                            std::pair{SecurityLevel::encrypt, "encrypt"}};

using Digest = std::array<std::uint8_t, EVP_MAX_MD_SIZE>;

Digest subject_digest(const std::string& common_name)
{
    const std::unique_ptr<X509_NAME, decltype(&X509_NAME_free)> subject{X509_NAME_new(), &X509_NAME_free};
    Digest digest{};
    unsigned length = 0;
    const auto* text = reinterpret_cast<const unsigned char*>(common_name.data());
    if (!subject ||
        X509_NAME_add_entry_by_NID(subject.get(), NID_commonName, MBSTRING_UTF8, text, static_cast<int>(common_name.size()), -1, 0) != 1 ||
        X509_NAME_digest(subject.get(), EVP_sha256(), digest.data(), &length) != 1)
        return {};  // longer than the 64 characters that a common name may have: no certificate has it either
    return digest;
}

}  // namespace

tl::expected<SecurityLevel, std::string> security_level_from(std::string_view word)
{
    for (const auto& [level, name] : levels) {
        if (word == name) return level;
    }
    return tl::make_unexpected(fmt::format("unknown level '{}'; known are encrypt, sign and none", word));
}

std::string_view to_string(SecurityLevel level)
{
    return levels[static_cast<std::size_t>(level)].second;
}

std::array<std::uint8_t, 6> guid_start(const std::string& common_name)
{
    const auto digest = subject_digest(common_name);
    std::array<std::uint8_t, 6> start{};
    for (std::size_t i = 0; i < start.size(); ++i) {
        const unsigned carried = i == 0 ? 1U : digest[i - 1] & 1U;
        start[i] = static_cast<std::uint8_t>(carried << 7U | digest[i] >> 1U);
    }
    return start;
}

bool suits(Vendor vendor, const std::string& common_name)
{
    constexpr std::uint8_t highest_free_bit = 0x40;  // the bit above it is set in all of them
    const bool upper_half = (guid_start(common_name)[0] & highest_free_bit) != 0;
    return upper_half == (vendor == Vendor::fastdds);
}

Sender make_sender(const std::string& name, const GuidPrefix& guid, bool secured)
{
    const auto start = guid_start(name);
    const bool bound = std::equal(start.begin(), start.end(), guid.begin());
    return {name, fmt::format("{:02x}", fmt::join(guid, "")), secured && !name.empty() && bound};
}

}  // namespace quorient::bus
