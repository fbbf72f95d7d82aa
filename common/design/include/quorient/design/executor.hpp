#pragma once

#include <cstddef>
#include <functional>

namespace quorient::design {

/// Calls task(i) for every i below count, in any order, on any thread; returns when all are done. What a task does depends on i alone, so
/// results do not depend on the executor.
using ForEach = std::function<void(std::size_t count, const std::function<void(std::size_t)>& task)>;

inline void in_turn(std::size_t count, const std::function<void(std::size_t)>& task)
{
    for (std::size_t i = 0; i < count; ++i) task(i);
}

}  // namespace quorient::design
