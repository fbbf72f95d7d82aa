#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace quorient::configuration {

/// The word that was probably meant: one that only adds to `word` ("range" for "range_deg_s"), or the one that is fewest edits away.
/// @returns empty if none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& words);

/// "; did you mean 'range_deg_s'?", or nothing.
std::string suggestion(std::string_view word, const std::vector<std::string>& words);

/// "a, b and c"
std::string listed(const std::vector<std::string>& words);

}  // namespace quorient::configuration
