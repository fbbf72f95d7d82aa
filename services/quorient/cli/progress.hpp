#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace quorient::cli {

/// A bar on stderr for work that takes more than two seconds; nothing where stderr is not a terminal.
class Progress {
public:
    Progress();
    ~Progress();  ///< takes the bar away
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// What is being done, behind the bar.
    void title(std::string text) { title_ = std::move(text); }

    void show(std::size_t done, std::size_t all);

    /// Where nobody knows how much there will be.
    void show(std::size_t done);

private:
    /// @returns whether anything is to be shown now.
    bool due();
    void print(const std::string& line);

    using Clock = std::chrono::steady_clock;
    bool terminal_;
    std::size_t shown_ = 0;  ///< characters on the line
    std::string title_;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point last_ = begin_;
};

}  // namespace quorient::cli
