#pragma once

#include <chrono>
#include <cstddef>

namespace quorient::cli {

/// A bar on stderr for work that takes more than two seconds; nothing where stderr is not a terminal.
class Progress {
public:
    Progress();
    ~Progress();  ///< takes the bar away
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(std::size_t done, std::size_t all);

private:
    using Clock = std::chrono::steady_clock;
    bool terminal_;
    bool shown_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point last_ = begin_;
};

}  // namespace quorient::cli
