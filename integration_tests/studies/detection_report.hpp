#pragma once

#include "detection_cells.hpp"
#include "exclusion_cost.hpp"
#include "study.hpp"

namespace quorient::studies {

/// Everything that the study measured.
struct DetectionFigures {
    std::vector<std::string> arrays;
    std::vector<Cell> cells;
    std::size_t bias_cells = 0;  ///< the first of them; the others are the kinds of faults
    std::vector<CellResult> results;
    std::vector<HealthyRun> healthy;
    std::vector<ExclusionCost> exclusion_costs;
};

Report detection_report(const DetectionFigures& figures, std::uint64_t trials);

}  // namespace quorient::studies
