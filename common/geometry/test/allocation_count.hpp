#pragma once

#include <cstddef>

namespace quorient::test {

/// Calls of operator new and of malloc (which Eigen uses) from our own objects so far. Needs the linker option --wrap=malloc.
std::size_t allocation_count();

}  // namespace quorient::test
