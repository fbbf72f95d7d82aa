#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <cstdio>
#include <string>

namespace quorient::cli {

namespace {

constexpr std::chrono::seconds shown_after{2};
constexpr std::chrono::milliseconds refresh{100};
constexpr std::size_t bar_width = 40;

}  // namespace

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress()
{
    if (shown_ > 0) fmt::print(stderr, "\r{:{}}\r", "", shown_);
}

void Progress::show(std::size_t done, std::size_t all)
{
    if (all == 0 || !due()) return;
    const std::size_t filled = bar_width * done / all;
    print(fmt::format("[{}{}] {:3d}% {}", std::string(filled, '='), std::string(bar_width - filled, ' '), 100 * done / all, title_));
}

void Progress::show(std::size_t done)
{
    if (due()) print(fmt::format("{} {}", done, title_));
}

bool Progress::due()
{
    const auto now = Clock::now();
    if (!terminal_ || now - begin_ < shown_after || now - last_ < refresh) return false;
    last_ = now;
    return true;
}

void Progress::print(const std::string& line)
{
    fmt::print(stderr, "\r{:<{}}", line, shown_);
    shown_ = line.size();
    std::fflush(stderr);
}

}  // namespace quorient::cli
