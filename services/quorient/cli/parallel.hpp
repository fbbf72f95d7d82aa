#pragma once

#include <cstddef>
#include <functional>

namespace quorient::cli {

/// Receives how many tasks are done, and how many there are; from any thread, one call at a time.
using OnProgress = std::function<void(std::size_t done, std::size_t all)>;

/// Calls task(i) for every i below count. @param threads  0 = one for each core.
void for_each(std::size_t count, unsigned threads, const OnProgress& on_progress, const std::function<void(std::size_t)>& task);

}  // namespace quorient::cli
