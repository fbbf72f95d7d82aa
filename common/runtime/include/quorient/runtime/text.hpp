#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace quorient::runtime {

/// The word that is fewest edits away from `word`; empty if none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& words);

}  // namespace quorient::runtime
