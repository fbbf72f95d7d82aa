#include "quorient/runtime/log.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace quorient::runtime {

void say(std::string_view text)
{
    std::fputs((std::string(text) + '\n').c_str(), stderr);
}

void start_log()
{
    spdlog::set_default_logger(spdlog::stderr_color_st("quorient"));
    spdlog::set_pattern("%H:%M:%S.%e %^%-5l%$ %v");
    if (const char* level = std::getenv("QUORIENT_LOG")) spdlog::set_level(spdlog::level::from_str(level));
}

int report(std::string_view problem)
{
    say(problem);
    return 2;
}

int guarded(const std::function<int(int, char**)>& body, int argc, char** argv)
{
    start_log();
    try {
        return body(argc, argv);
    } catch (const std::exception& error) {
        say(error.what());
        return 1;
    }
}

}  // namespace quorient::runtime
