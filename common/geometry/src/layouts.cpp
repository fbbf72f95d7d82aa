#include "quorient/geometry/layouts.hpp"

#include "catalogue.hpp"
#include "families.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <utility>

namespace quorient::geometry {

namespace {

/// Levenshtein's distance: how many letters to insert, delete or change.
std::size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, change}));
        }
    }
    return row.back();
}

std::string nearest_name(std::string_view misspelt)
{
    const auto entries = catalogue();
    return std::ranges::min_element(entries, {}, [&](const CatalogueEntry& entry) { return edit_distance(misspelt, entry.name); })->name;
}

}  // namespace

tl::expected<SensorCluster, std::string> layout(std::string_view name)
{
    for (const NamedLayout& named : named_layouts())
        if (named.name == name) return make_cluster(named.axes(), named.instrument);
    if (auto member = family_member(name)) return *member;
    return tl::unexpected(fmt::format("unknown layout '{}'; did you mean '{}'?", name, nearest_name(name)));
}

std::vector<CatalogueEntry> catalogue()
{
    std::vector<CatalogueEntry> entries;
    for (const NamedLayout& named : named_layouts()) entries.push_back({std::string(named.name), std::string(named.source)});
    for (const Family& family : families()) entries.push_back({std::string(family.pattern), std::string(family.source)});
    return entries;
}

}  // namespace quorient::geometry
