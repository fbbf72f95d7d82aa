#include "single_frame/exact_pattern.hpp"

#include <bit>
#include <cassert>

namespace quorient::fdi {

std::optional<AxisMask> exact_pattern(std::span<const AxisMask> reads, std::span<const std::uint8_t> passed, unsigned max_faults)
{
    assert(reads.size() == passed.size());
    AxisMask read_by_any = 0;
    AxisMask read_by_passed = 0;
    for (std::size_t k = 0; k < reads.size(); ++k) {
        read_by_any |= reads[k];
        if (passed[k] != 0) read_by_passed |= reads[k];
    }
    const AxisMask faulty = read_by_any & ~read_by_passed;
    if (static_cast<unsigned>(std::popcount(faulty)) > max_faults) return {};

    AxisMask told_apart = 0;  // axes of w that fail a comparison alone: without one, w without that axis gives the same pattern
    for (std::size_t k = 0; k < reads.size(); ++k) {
        const AxisMask blamed = reads[k] & faulty;
        if ((blamed == 0) != (passed[k] != 0)) return {};
        if (std::has_single_bit(blamed)) told_apart |= blamed;
    }
    if (told_apart != faulty) return {};
    return faulty;
}

}  // namespace quorient::fdi
