#pragma once

#include "quorient/recording/instrument_log.hpp"

namespace quorient::recording::ros {

/// A bag as ROS 2 leaves it: a folder with metadata.yaml and one file or several, in the order of their names.
/// @returns an error if no file in the folder is one of a bag.
tl::expected<std::unique_ptr<InstrumentLog>, std::string> open_bag_directory(const std::filesystem::path& directory);

}  // namespace quorient::recording::ros
