#pragma once

#include "quorient/design/bounds.hpp"
#include "quorient/design/executor.hpp"
#include "quorient/design/figures.hpp"

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::design {

/// How places are chosen where there is a finite number of them.
enum class PlaceSearch : std::uint8_t {
    automatic,   ///< every choice where there are at most `most_choices`, else by exchange
    exhaustive,  ///< every choice
    exchange,    ///< from random choices, one instrument at a time to a better place
};

/// A search's time grows with about the fifth power of the number of axes, so large arrays get fewer starts.
inline constexpr std::size_t usual_starts = 24;
constexpr std::size_t starts_for(std::size_t axes)
{
    return axes <= 12 ? usual_starts : axes <= 16 ? usual_starts / 3 : usual_starts / 12;
}

struct SearchSettings {
    Objective objective = Objective::trace;
    std::uint64_t seed = 1;
    std::size_t starts = usual_starts;  ///< random ones
    std::size_t designs = 5;   ///< at most
    PlaceSearch places = PlaceSearch::automatic;
};

inline constexpr std::size_t most_choices = 300'000;

struct Design {
    geometry::SensorCluster cluster;  ///< noise in sigma; kept axes first
    Figures figures;
    unsigned symmetry = 1;  ///< order of the rotation about z that leaves the array as it is
};

/// How a result came about.
enum class Searched : std::uint8_t {
    locally,    ///< from random starts
    wholly,     ///< every choice of places
    by_exchange,
};

struct SearchResult {
    /// Best first; none is dominated by another one found. Empty where no array met the limits.
    /// Where some array names every failure that the brief demands, only such arrays.
    std::vector<Design> designs;
    std::vector<Design> nearest;  ///< where designs is empty: the one that came nearest
    Bounds bounds;
    Searched searched = Searched::locally;
    std::size_t tried = 0;  ///< local searches, or choices of places
};

/// The best arrays for a brief: the Pareto front of what was found, by several aims from many starts (or all choices of places), each
/// refined by sequential quadratic programming.
/// Deterministic for a seed, whatever the executor.
/// @returns what forbids the brief, or why its mission cannot be played.
tl::expected<SearchResult, Refusal> search(const Brief& brief, const SearchSettings& settings, const ForEach& for_each = in_turn);

/// An array without one of its axes (or instruments, where failures take those).
struct Removal {
    std::size_t unit = 0;
    Figures figures;
};

/// What each removal costs, the cheapest first (by the objective, then as in `better`).
std::vector<Removal> removals(const geometry::SensorCluster& cluster, bool instruments, unsigned failures, Objective objective);

}  // namespace quorient::design
