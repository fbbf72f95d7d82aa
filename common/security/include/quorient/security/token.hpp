#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace quorient::security {

/// A secret that a request shows in place of a certificate. It is never printed.
class Token {
public:
    /// Reads the one line of a file that only its owner (and group) can read. At least 32 characters of RFC 6750 [section 2.1].
    /// @returns an error with the file and what to do; it does not repeat the content.
    static tl::expected<Token, std::string> read(const std::filesystem::path& file);

    /// Whether a request's header `Authorization` is "Bearer " and this token. The time of the comparison does not depend on the content.
    bool admits(std::string_view authorization) const;

private:
    explicit Token(std::string text) : text_(std::move(text)) {}

    std::string text_;
};

}  // namespace quorient::security
