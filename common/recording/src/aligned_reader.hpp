#pragma once

#include "quorient/recording/reader.hpp"

namespace quorient::recording {

/// A log of instruments with times of their own as frames of one cluster: those that the survey compares, on common intervals.
/// Reads the log twice.
tl::expected<std::unique_ptr<Reader>, std::string> open_aligned(const std::filesystem::path& file);

}  // namespace quorient::recording
