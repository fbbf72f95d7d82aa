#include "quorient/security/token.hpp"

#include "files.hpp"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <sys/stat.h>

namespace quorient::security {

namespace {

constexpr std::size_t shortest = 32;
constexpr std::string_view characters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~+/=";
constexpr std::string_view scheme = "Bearer ";

}  // namespace

tl::expected<Token, std::string> Token::read(const std::filesystem::path& file)
{
    const auto problem = [&](std::string_view what, std::string_view remedy) {
        return tl::make_unexpected(fmt::format("{}: {}: {}", file.string(), what, remedy));
    };
    const auto make = fmt::format("(umask 077; openssl rand -hex 32 > {}) makes one", file.string());
    auto text = read_file(file);
    if (!text) return problem("cannot be read: " + text.error(), make);
    struct stat status {};
    constexpr mode_t others = S_IRWXO | S_IWGRP;
    if (::stat(file.c_str(), &status) != 0 || (status.st_mode & others) != 0)
        return problem(fmt::format("others may read or write it (mode {:04o})", status.st_mode & 07777U), "chmod 600");
    if (text->ends_with('\n')) text->pop_back();
    if (text->size() < shortest || text->find_first_not_of(characters) != std::string::npos)
        return problem(fmt::format("expected one line of at least {} letters, digits and -._~+/=", shortest), make);
    return Token{std::move(*text)};
}

bool Token::admits(std::string_view authorization) const
{
    if (!authorization.starts_with(scheme)) return false;
    const auto shown = authorization.substr(scheme.size());
    return shown.size() == text_.size() && CRYPTO_memcmp(shown.data(), text_.data(), text_.size()) == 0;
}

}  // namespace quorient::security
