#include "field/suspicions.hpp"

#include <algorithm>

namespace quorient::fdi::field {
namespace {

double largest_but(std::size_t m, const std::array<double, max_members>& of)
{
    double largest = 0;
    for (std::size_t j = 0; j < of.size(); ++j)
        if (j != m) largest = std::max(largest, of[j]);
    return largest;
}

}  // namespace

std::optional<Suspicion> Suspicions::contradicted() const
{
    const Suspicion& top = largest();
    const double others = std::max(largest_but(top.instrument, brief_of), largest_but(top.instrument, lasting_of));
    if (top.certainty > 1 && top.certainty > Windows::margin * others) return top;
    return std::nullopt;
}

std::optional<Suspicion> Suspicions::proved() const
{
    if (lasting.certainty > 1 && lasting.certainty > Windows::margin * largest_but(lasting.instrument, lasting_of)) return lasting;
    return std::nullopt;
}

}  // namespace quorient::fdi::field
