#pragma once

#include "cli/json_output.hpp"
#include "quorient/design/search.hpp"

#include <string>

namespace quorient::cli {

/// The result in the fields of the verb's contract (docs/command-line.md); what is undefined or infinite is null.
Json design_json(const design::SearchResult& result);

/// "all 28 choices of places", "288 local searches".
std::string how_searched(const design::SearchResult& result);

/// The mission that is played, in one sentence.
std::string mission_text(const design::Mission& mission);

/// Axes and figures of every design, beside the bounds that no array passes.
std::string design_text(const design::Brief& brief, const design::SearchResult& result, design::Objective objective);

/// Axes and figures of one design.
std::string design_table(const design::Design& design, const design::Bounds& bounds);

/// The figures that `quorient design` compares, of any cluster: for `quorient layout --design`.
std::string figures_text(const design::Figures& figures, const design::Bounds& bounds, bool unit_noise = true);
Json figures_json(const design::Figures& figures);

/// What each removal costs.
std::string removals_text(const geometry::SensorCluster& cluster, const std::vector<design::Removal>& removals, bool instruments);
Json removals_json(const std::vector<design::Removal>& removals, bool instruments);

/// The array as an axes file (YAML), for `unit.axes` of a system file and for `--axes`.
std::string axes_file_text(const design::Design& design, const std::string& origin);

}  // namespace quorient::cli
