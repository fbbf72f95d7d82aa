#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <string_view>

namespace quorient::cli {

/// Ends a verb on bad usage or bad input: the explanation on stderr, exit code 2.
[[noreturn]] inline void fail(std::string_view explanation)
{
    fmt::print(stderr, "{}\n", explanation);
    throw CLI::RuntimeError(2);
}

}  // namespace quorient::cli
