#pragma once

#include "quorient/configuration/key.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace quorient::configuration {

/// Every mapping beneath a chapter as Markdown, each with a heading and a table of its keys.
/// @param name  of the mapping that the chapter describes, as a heading
std::string reference(const Chapter& chapter, const std::string& name);

/// The same for a terminal.
std::string explanation(const Chapter& chapter, const std::string& name);

/// One key, with all that is beneath it, for a terminal.
/// @param path  "lanes.detector.sigma"; items of lists without their number. @returns nothing where no such key is
std::optional<std::string> explanation_of(const Chapter& chapter, std::string_view path);

/// "number, above 0 [rad]"
std::string value_text(const Key& key);

}  // namespace quorient::configuration
