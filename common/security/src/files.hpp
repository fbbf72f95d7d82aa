#pragma once

#include <sys/types.h>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>

namespace quorient::security {

/// Keys, certificates and tokens are small: reads at most 16 MB, so that an endless file (/dev/zero) is refused.
/// @returns the system's error text, e.g. "No such file or directory", or "more than 16 MB".
tl::expected<std::string, std::string> read_file(const std::filesystem::path& path);

/// Writes the whole file or nothing. It is never readable by more users than `mode` allows, not even for a moment.
/// @returns an error with the path.
tl::expected<void, std::string> write_file(const std::filesystem::path& path, const std::string& content, mode_t mode);

}  // namespace quorient::security
