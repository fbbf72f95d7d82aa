#pragma once

#include <sys/types.h>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>

namespace quorient::security {

/// @returns the system's error text, e.g. "No such file or directory".
tl::expected<std::string, std::string> read_file(const std::filesystem::path& path);

/// Writes the whole file or nothing. It is never readable by more users than `mode` allows, not even for a moment.
/// @returns an error with the path.
tl::expected<void, std::string> write_file(const std::filesystem::path& path, const std::string& content, mode_t mode);

}  // namespace quorient::security
