#include "quorient/security/identity.hpp"

#include "certificates.hpp"
#include "documents.hpp"
#include "files.hpp"
#include "layout.hpp"
#include "quorient/bus/settings.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <utility>

namespace quorient::security {

namespace {

/// Checks one file after the other and collects the problems.
class Inspection {
public:
    Inspection(const std::filesystem::path& directory, const Joining& joining, std::int64_t now_s)
        : layout_{directory}, joining_(joining), now_s_(now_s)
    {
    }

    tl::expected<Identity, std::vector<std::string>> run()
    {
        identity_ca_ = read(layout_.identity_ca(), certificate_from, "a certificate");
        permissions_ca_ = read(layout_.permissions_ca(), certificate_from, "a certificate");
        revoked_ = read(layout_.revoked(), revocation_list_from, "a list of revoked certificates");
        look_at_governance();
        look_at_certificate();
        look_at_key();
        look_at_permissions();
        if (!problems_.empty()) return tl::make_unexpected(std::move(problems_));
        return Identity{files(), validity_of(*certificate_).until_s};
    }

private:
    std::string again() const { return fmt::format("quorient keys SYSTEM.yaml --out {} makes it", layout_.directory.string()); }
    std::string renewal() const { return fmt::format("quorient keys --out {} --renew {}", layout_.directory.string(), joining_.name); }

    void problem(const std::filesystem::path& file, std::string_view what, std::string_view remedy)
    {
        problems_.push_back(fmt::format("{}: {}: {}", file.string(), what, remedy));
    }

    template <class Parse>
    auto read(const std::filesystem::path& file, Parse parse, std::string_view expected) -> decltype(parse(std::string{}))
    {
        const auto text = read_file(file);
        if (!text) {
            problem(file, "cannot be read: " + text.error(), again());
            return nullptr;
        }
        auto parsed = parse(*text);
        if (!parsed) problem(file, fmt::format("is not {} (PEM)", expected), again());
        return parsed;
    }

    /// @returns the content of a signed document, empty if its signature is not valid.
    std::string read_signed(const std::filesystem::path& file)
    {
        const auto text = read_file(file);
        if (!text) problem(file, "cannot be read: " + text.error(), again());
        if (!text || !permissions_ca_) return {};
        const auto document = verified(*text, *permissions_ca_);
        if (!document) problem(file, document.error(), again());
        return document ? *document : std::string{};
    }

    void look_at_domain(const std::filesystem::path& file, std::uint32_t domain)
    {
        if (domain != joining_.domain)
            problem(file, fmt::format("it is for domain {}, and {} is to join domain {}", domain, joining_.name, joining_.domain), again());
    }

    void look_at_governance()
    {
        const auto document = read_signed(layout_.governance());
        if (document.empty()) return;
        const auto governance = read_governance(document);
        if (!governance) return problem(layout_.governance(), governance.error(), again());
        look_at_domain(layout_.governance(), governance->domain);
        if (governance->level != joining_.level)
            problem(layout_.governance(),
                    fmt::format("its level is {}, the system's {}", bus::to_string(governance->level), bus::to_string(joining_.level)), again());
    }

    void look_at_certificate()
    {
        const auto file = layout_.certificate(joining_.name, joining_.vendor);
        certificate_ = read(file, certificate_from, "a certificate");
        if (!certificate_ || !identity_ca_ || !revoked_) return;
        if (const auto why = refusal(*certificate_, *identity_ca_, *revoked_, now_s_); !why.empty()) {
            const auto until_s = static_cast<std::time_t>(validity_of(*certificate_).until_s);
            problem(file, fmt::format("{} (valid until {:%Y-%m-%d %H:%M} UTC)", why, fmt::gmtime(until_s)),
                    why.find("revoked") == std::string::npos ? renewal() : again());
        }
        const auto common_name = common_name_of(*certificate_);
        if (!common_name.starts_with(joining_.name + ".") || !bus::suits(joining_.vendor, common_name))
            problem(file, fmt::format("CN={} is not {} on {}", common_name, joining_.name, bus::to_string(joining_.vendor)), again());
    }

    void look_at_key()
    {
        const auto file = layout_.key(joining_.name);
        const auto key = read(file, key_from, "a private key without a password");
        if (!key) return;
        if (certificate_ && X509_check_private_key(certificate_.get(), key.get()) != 1)
            problem(file, fmt::format("is not the key of {}", layout_.certificate(joining_.name, joining_.vendor).string()), renewal());
        struct stat status {};
        constexpr mode_t others = S_IRWXO | S_IWGRP;
        if (::stat(file.c_str(), &status) == 0 && (status.st_mode & others) != 0)
            problem(file, fmt::format("others may read or write it (mode {:04o})", status.st_mode & 07777U), "chmod 600");
    }

    void look_at_permissions()
    {
        const auto file = layout_.permissions(joining_.name);
        const auto document = read_signed(file);
        if (document.empty() || !certificate_) return;
        const auto permissions = read_permissions(document, common_name_of(*certificate_));
        if (!permissions) return problem(file, permissions.error(), again());
        look_at_domain(file, permissions->domain);
    }

    bus::SecurityFiles files() const
    {
        return {common_name_of(*certificate_),
                layout_.identity_ca(),
                layout_.certificate(joining_.name, joining_.vendor),
                layout_.key(joining_.name),
                layout_.permissions_ca(),
                layout_.governance(),
                layout_.permissions(joining_.name),
                layout_.revoked()};
    }

    Layout layout_;
    Joining joining_;
    std::int64_t now_s_;
    std::vector<std::string> problems_;
    Certificate identity_ca_, permissions_ca_, certificate_;
    RevocationList revoked_;
};

}  // namespace

tl::expected<Identity, std::vector<std::string>> find_identity(const std::filesystem::path& directory, const Joining& joining,
                                                               std::int64_t now_s)
{
    std::error_code unknown;
    const auto absolute = std::filesystem::absolute(directory, unknown);
    for (const auto& folder : {absolute, Layout{absolute}.of(joining.name)}) {
        if (std::filesystem::is_directory(folder, unknown)) continue;
        return tl::make_unexpected(std::vector{fmt::format("{}: there is no such directory: quorient keys SYSTEM.yaml --out {} makes it",
                                                           folder.string(), absolute.string())});
    }
    return Inspection{absolute, joining, now_s}.run();
}

tl::expected<Governance, std::string> find_governance(const std::filesystem::path& directory)
{
    const Layout layout{directory};
    const auto remedy = fmt::format("quorient keys SYSTEM.yaml --out {} makes it", directory.string());
    const auto text = read_file(layout.governance());
    if (!text) return tl::make_unexpected(fmt::format("{}: cannot be read: {}: {}", layout.governance().string(), text.error(), remedy));
    const auto authority_text = read_file(layout.permissions_ca());
    const auto authority = authority_text ? certificate_from(*authority_text) : nullptr;
    if (!authority) return tl::make_unexpected(fmt::format("{}: is missing, or not a certificate: {}", layout.permissions_ca().string(), remedy));
    auto governance = verified(*text, *authority).and_then(read_governance);
    if (!governance) return tl::make_unexpected(fmt::format("{}: {}: {}", layout.governance().string(), governance.error(), remedy));
    return governance;
}

}  // namespace quorient::security
