#pragma once

#include "quorient/recording/instrument_log.hpp"

#include <string>
#include <vector>

namespace quorient::recording {

/// A log of instruments with times of their own as frames of one cluster: those that the survey compares, on common intervals.
/// Reads the log twice. @param remarks  takes what is to be said of how the log was understood
tl::expected<std::unique_ptr<Reader>, std::string> open_aligned(const std::filesystem::path& file, const LogOptions& options,
                                                                  std::vector<std::string>& remarks);

/// open_log of a log that may need options.
tl::expected<std::unique_ptr<Reader>, std::string> open_log(const std::filesystem::path& file, const LogOptions& options,
                                                            std::vector<std::string>& remarks);

}  // namespace quorient::recording
