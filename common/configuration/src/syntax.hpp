#pragma once

#include <yaml-cpp/exceptions.h>
#include <string>

namespace quorient::configuration {

/// A syntax error of a YAML text, in the words that a user expects.
struct SyntaxError {
    int line = 1;
    int column = 1;
    std::string text;
};

SyntaxError syntax_error(const YAML::Exception& error, const std::string& text);

}  // namespace quorient::configuration
