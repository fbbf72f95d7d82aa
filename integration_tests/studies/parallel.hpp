#pragma once

#include "monte_carlo.hpp"

#include <cstddef>
#include <functional>

namespace quorient::studies {

/// Calls task(i) for every i below count, on settings.threads cores.
void for_each(std::size_t count, const RunSettings& settings, const OnProgress& on_progress, const std::function<void(std::size_t)>& task);

}  // namespace quorient::studies
