#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quorient::fuzz {

using Input = std::vector<std::uint8_t>;

/// Runs a target within a test: the corpus and so many inputs, or more for as long as QUORIENT_FUZZ_SECONDS. The first one is number
/// QUORIENT_FUZZ_SEED. Fails if the memory grows; an input that ends the process, or takes too long, is named first.
/// @param name     of the corpus: fuzz/corpus/NAME.txt, which may be absent
/// @param longest  bytes of a random input
/// @param more     inputs that belong to the corpus too
void run(const char* name, void (*target)(const std::uint8_t*, std::size_t), std::uint64_t inputs, std::size_t longest,
         std::vector<Input> more = {});

}  // namespace quorient::fuzz
