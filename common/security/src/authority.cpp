#include "quorient/security/authority.hpp"

#include "books.hpp"
#include "certificates.hpp"
#include "documents.hpp"
#include "files.hpp"
#include "layout.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <algorithm>
#include <array>
#include <optional>

namespace quorient::security {

namespace {

using Done = tl::expected<void, std::string>;

constexpr std::int64_t day_s = 24 * 3600;
constexpr std::int64_t authority_lifetime_s = 3650 * day_s;
constexpr mode_t for_all = 0644;
constexpr mode_t for_owner = 0600;
constexpr std::array vendors{Vendor::fastdds, Vendor::cyclonedds};

/// A common name has at most 64 characters; what common_name_for() appends fits into the rest.
constexpr std::size_t longest_name = 40;

Validity from_yesterday(std::int64_t now_s, std::int64_t lifetime_s)
{
    return {now_s - day_s, now_s + lifetime_s};
}

/// The name becomes a folder and a part of a certificate's subject. @returns empty if it may.
std::string objection_to(const std::string& name)
{
    const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_'; };
    if (name.empty() || name.size() > longest_name || !std::ranges::all_of(name, plain))
        return fmt::format("'{}' cannot be an identity: 1 to {} letters, digits, '-' and '_'", name, longest_name);
    return name == "authority" || name == "shared" ? fmt::format("'{}' cannot be an identity: the folder is taken", name) : "";
}

/// Counts up to the first name with which the handshake works with both vendors.
std::string common_name_for(const std::string& name, Vendor vendor)
{
    for (unsigned number = 0;; ++number) {
        auto common_name = fmt::format("{}.{}.{}", name, vendor == Vendor::fastdds ? "fastdds" : "cyclonedds", number);
        if (bus::suits(vendor, common_name)) return common_name;
    }
}

Done make_directory(const std::filesystem::path& path, mode_t mode)
{
    std::error_code failed;
    std::filesystem::create_directories(path, failed);
    if (!failed && ::chmod(path.c_str(), mode) == 0) return {};
    return tl::make_unexpected(fmt::format("{}: cannot be made: {}", path.string(), failed ? failed.message() : "its mode cannot be set"));
}

tl::expected<Issuer, std::string> read_issuer(const std::filesystem::path& certificate_file, const std::filesystem::path& key_file)
{
    const auto certificate_text = read_file(certificate_file);
    if (!certificate_text) return tl::make_unexpected(fmt::format("{}: cannot be read: {}", certificate_file.string(), certificate_text.error()));
    const auto key_text = read_file(key_file);
    if (!key_text) return tl::make_unexpected(fmt::format("{}: cannot be read: {}", key_file.string(), key_text.error()));
    Issuer issuer{certificate_from(*certificate_text), key_from(*key_text)};
    if (!issuer.certificate || !issuer.key || X509_check_private_key(issuer.certificate.get(), issuer.key.get()) != 1)
        return tl::make_unexpected(fmt::format("{}: it is not the key of {}", key_file.string(), certificate_file.string()));
    return issuer;
}

Done write_issuer(const Issuer& issuer, const std::filesystem::path& certificate_file, const std::filesystem::path& key_file)
{
    return write_file(key_file, pem_of(*issuer.key), for_owner).and_then([&] {
        return write_file(certificate_file, pem_of(*issuer.certificate), for_all);
    });
}

}  // namespace

struct Authority::Books {
    Layout layout;
    Issuer identity_ca;
    Issuer permissions_ca;
    Record record{};

    IssuedIdentity* find(const std::string& name)
    {
        const auto found = std::ranges::find(record.identities, name, [](const IssuedIdentity& identity) { return identity.member.name; });
        return found == record.identities.end() ? nullptr : &*found;
    }

    Done save() const { return write_file(layout.books(), to_text(record), for_owner); }

    Done write_revoked(std::int64_t now_s) const
    {
        const auto validity = from_yesterday(now_s, validity_of(*identity_ca.certificate).until_s - now_s);
        return write_file(layout.revoked(), pem_of(*security::revoke(identity_ca, record.revoked_serials, validity)), for_all);
    }

    Done write_permissions(const IssuedIdentity& identity, std::int64_t now_s) const
    {
        Permissions permissions{record.domain, {}, identity.member.access, {now_s - day_s, 0}};
        for (const auto& certificate : identity.certificates) {
            permissions.common_names.push_back(certificate.common_name);
            permissions.validity.until_s = std::max(permissions.validity.until_s, certificate.expires_s);
        }
        return write_file(layout.permissions(identity.member.name), sign(permissions_document(permissions), permissions_ca), for_all);
    }
};

Authority::Authority(std::unique_ptr<Books> books) : books_(std::move(books)) {}
Authority::Authority(Authority&&) noexcept = default;
Authority& Authority::operator=(Authority&&) noexcept = default;
Authority::~Authority() = default;

tl::expected<Authority, std::string> Authority::open(const std::filesystem::path& directory)
{
    const Layout layout{directory};
    std::error_code unknown;
    if (!std::filesystem::exists(layout.authority(), unknown))
        return tl::make_unexpected(fmt::format("{}: there is no authority: quorient keys SYSTEM.yaml --out {} makes one",
                                               layout.authority().string(), directory.string()));
    auto identity_ca = read_issuer(layout.identity_ca(), layout.identity_ca_key());
    if (!identity_ca) return tl::make_unexpected(identity_ca.error());
    auto permissions_ca = read_issuer(layout.permissions_ca(), layout.permissions_ca_key());
    if (!permissions_ca) return tl::make_unexpected(permissions_ca.error());
    const auto text = read_file(layout.books());
    if (!text) return tl::make_unexpected(fmt::format("{}: cannot be read: {}", layout.books().string(), text.error()));
    auto record = record_from(*text);
    if (!record) return tl::make_unexpected(fmt::format("{}: {}", layout.books().string(), record.error()));
    return Authority{std::make_unique<Books>(Books{layout, std::move(*identity_ca), std::move(*permissions_ca), std::move(*record)})};
}

tl::expected<Authority, std::string> Authority::open_or_make(const std::filesystem::path& directory, std::int64_t now_s)
{
    const Layout layout{directory};
    std::error_code unknown;
    // The record is written last. Without it an earlier run was interrupted: start again.
    if (std::filesystem::exists(layout.books(), unknown)) return open(directory);
    const auto validity = from_yesterday(now_s, authority_lifetime_s);
    auto books = std::make_unique<Books>(
        Books{layout, make_issuer("Quorient identities", validity, false), make_issuer("Quorient permissions", validity, true)});
    const auto done =
        make_directory(directory, 0755)
            .and_then([&] { return make_directory(layout.authority(), 0700); })
            .and_then([&] { return make_directory(layout.shared(), 0755); })
            .and_then([&] { return write_issuer(books->identity_ca, layout.identity_ca(), layout.identity_ca_key()); })
            .and_then([&] { return write_issuer(books->permissions_ca, layout.permissions_ca(), layout.permissions_ca_key()); })
            .and_then([&] { return books->write_revoked(now_s); })
            .and_then([&] { return books->save(); });
    if (!done) return tl::make_unexpected(done.error());
    return Authority{std::move(books)};
}

std::uint32_t Authority::domain() const
{
    return books_->record.domain;
}

bus::SecurityLevel Authority::level() const
{
    return books_->record.level;
}

const std::vector<IssuedIdentity>& Authority::identities() const
{
    return books_->record.identities;
}

const IssuedIdentity* Authority::find(const std::string& name) const
{
    return books_->find(name);
}

Done Authority::govern(std::uint32_t domain, bus::SecurityLevel level, std::int64_t now_s)
{
    const bool moved = domain != books_->record.domain;
    books_->record.domain = domain;
    books_->record.level = level;
    if (const auto done = write_file(books_->layout.governance(), sign(governance_document({domain, level}), books_->permissions_ca), for_all); !done)
        return done;
    for (const auto& identity : books_->record.identities) {
        if (!moved || identity.revoked) continue;
        if (const auto done = books_->write_permissions(identity, now_s); !done) return done;
    }
    return books_->save();
}

Done Authority::issue(const Member& member, std::int64_t now_s, std::int64_t lifetime_s)
{
    if (const auto objection = objection_to(member.name); !objection.empty()) return tl::make_unexpected(objection);
    const auto& layout = books_->layout;
    const auto validity = from_yesterday(now_s, lifetime_s);
    const auto key = make_key();
    IssuedIdentity identity{member, {}, false};
    std::array<Certificate, vendors.size()> certificates;
    for (std::size_t i = 0; i < vendors.size(); ++i) {
        certificates[i] = security::issue(books_->identity_ca, *key, common_name_for(member.name, vendors[i]), validity);
        identity.certificates.push_back({common_name_of(*certificates[i]), serial_of(*certificates[i]), validity.until_s});
        books_->record.serials[member.name].push_back(identity.certificates.back().serial);
    }
    // The record first: a certificate that it does not contain could not be revoked.
    auto done = books_->save()
                    .and_then([&] { return make_directory(layout.of(member.name), 0755); })
                    .and_then([&] { return write_file(layout.key(member.name), pem_of(*key), for_owner); });
    for (std::size_t i = 0; i < vendors.size(); ++i)
        done = done.and_then([&] { return write_file(layout.certificate(member.name, vendors[i]), pem_of(*certificates[i]), for_all); });
    done = done.and_then([&] { return books_->write_permissions(identity, now_s); });
    if (!done) return done;
    if (auto* known = books_->find(member.name)) *known = std::move(identity);
    else books_->record.identities.push_back(std::move(identity));
    return books_->save();
}

Done Authority::permit(const Member& member, std::int64_t now_s)
{
    auto* identity = books_->find(member.name);
    if (!identity) return tl::make_unexpected(fmt::format("there is no identity '{}'", member.name));
    identity->member = member;
    return books_->write_permissions(*identity, now_s).and_then([&] { return books_->save(); });
}

Done Authority::revoke(const std::string& name, std::int64_t now_s)
{
    auto* identity = books_->find(name);
    if (!identity) return tl::make_unexpected(fmt::format("there is no identity '{}'", name));
    identity->revoked = true;
    auto& revoked = books_->record.revoked_serials;
    for (const auto& serial : books_->record.serials[name]) {
        if (std::ranges::find(revoked, serial) == revoked.end()) revoked.push_back(serial);
    }
    return books_->write_revoked(now_s).and_then([&] { return books_->save(); });
}

}  // namespace quorient::security
