#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace quorient::fuzz {

/// Small sound logs, for the fuzz targets of their readers to begin with. Made by the writers of the readers' tests: no recording is
/// among them.
/// @param target  dataflash, ulog, csv, mcap, sqlite, logs for all of them, or times
std::vector<std::vector<std::uint8_t>> log_seeds(const std::string& target);

}  // namespace quorient::fuzz
