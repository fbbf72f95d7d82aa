#pragma once

#include "quorient/design/search.hpp"

#include <map>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace quorient::cli {

/// A brief as read from a file, and where each demand stands in it.
struct BriefFile {
    design::Brief brief;
    std::string keep;                          ///< the value of `keep`: a layout or a file of axes, not loaded yet
    std::map<std::string, std::string> place;  ///< by key: "file:line:column"
};

/// Reads a brief (docs/design-an-array.md). @returns every problem of the file at once, each with file:line:column.
tl::expected<BriefFile, std::string> load_brief(const std::string& file);

/// The mounting of this name (free, cone, right-angles), or of a file that holds the mapping `mounting` of a brief.
tl::expected<design::Mounting, std::string> load_mounting(const std::string& name_or_file);

}  // namespace quorient::cli
