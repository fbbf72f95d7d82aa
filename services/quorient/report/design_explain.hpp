#pragma once

#include "quorient/design/search.hpp"

#include <cstdint>
#include <string>

namespace quorient::cli {

/// One page for a builder: what was compared, what the winner costs and gains against the common choices, what two failures leave, and how
/// far the bounds are. For a result with a design.
std::string explained(const design::Brief& brief, const design::SearchResult& result, std::uint64_t seed, const design::ForEach& for_each);

}  // namespace quorient::cli
