#pragma once

#include "frame_reader.hpp"

#include <filesystem>
#include <span>

namespace quorient::recording::mcap {

/// The files of one recording that was rotated, as one log, in the order of their frames whatever the order of their names.
/// @returns nothing unless each file is a record of the same unit and epoch
std::optional<std::unique_ptr<Reader>> open_parts(std::span<const std::filesystem::path> files);

}  // namespace quorient::recording::mcap
