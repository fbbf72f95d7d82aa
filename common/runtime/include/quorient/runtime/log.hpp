#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace quorient::runtime {

/// Logs go to stderr, a line each: time, level, text. $QUORIENT_LOG sets the level (debug, info, warn, error).
void start_log();

/// A line on stderr. Throws nothing: where that cannot be written, nobody is left to read it.
void say(std::string_view text);

/// Explains a problem (one or several lines) on stderr. @returns 2, the exit code of bad input.
int report(std::string_view problem);

/// Runs a service's main: an environment that refuses an entity at start-up is reported, exit code 1.
int guarded(const std::function<int(int, char**)>& body, int argc, char** argv);

}  // namespace quorient::runtime
