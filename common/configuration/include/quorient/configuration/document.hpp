#pragma once

#include "quorient/configuration/problems.hpp"

#include <yaml-cpp/yaml.h>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace quorient::configuration {

/// Reads a YAML file whose root is a mapping. @returns the one problem of a file that cannot be read or parsed.
tl::expected<YAML::Node, Problems> load_yaml(const std::string& file);

/// The same of a text; `name` stands for the file in messages.
tl::expected<YAML::Node, Problems> parse_yaml(const std::string& text, const std::string& name);

/// One value in place of a document's.
struct Assignment {
    std::string path;   ///< "lanes[0].detector.sigma"
    std::string value;  ///< YAML
    bool append = false;
};

/// `a.b=value`, or `a.b+=value` to append to a list. @returns an error for text that is no assignment.
tl::expected<Assignment, std::string> parse_assignment(const std::string& text);

/// Sets the value: `null` takes a key out. Keys on the way that are not there are made. An item of a list is named by its number
/// (`lanes[0]`), or by its own `name` (`lanes.a`).
/// @returns the path of what was set with all items by their number, as messages name it; or what is wrong with the path or the value.
tl::expected<std::string, std::string> assign(YAML::Node document, const Assignment& assignment);
tl::expected<std::string, std::string> assign(YAML::Node document, const std::string& assignment);

/// Where a key stands: the place of its value; where it is absent, that of the mapping that should have it.
/// @param path  "lanes[0].detector.method"
YAML::Mark place_of(const YAML::Node& document, std::string_view path);

/// Whether a key stands in the document with a value.
bool stands(const YAML::Node& document, std::string_view path);

/// A problem with the value of a key, found after the document was read.
void report(Problems& problems, const YAML::Node& document, std::string_view path, std::string_view what);

}  // namespace quorient::configuration
