#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <cstdio>
#include <string>

namespace quorient::cli {

namespace {

constexpr std::chrono::seconds patience{2};
constexpr std::chrono::milliseconds refresh{100};
constexpr std::size_t width = 40;

}  // namespace

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress()
{
    if (shown_) fmt::print(stderr, "\r{:{}}\r", "", width + 7);
}

void Progress::show(std::size_t done, std::size_t all)
{
    if (!terminal_ || all == 0) return;
    const auto now = Clock::now();
    if (now - begin_ < patience || now - last_ < refresh) return;
    last_ = now;
    shown_ = true;
    const std::size_t filled = width * done / all;
    fmt::print(stderr, "\r[{}{}] {:3d}%", std::string(filled, '='), std::string(width - filled, ' '), 100 * done / all);
    std::fflush(stderr);
}

}  // namespace quorient::cli
