#pragma once

#include "field_figures.hpp"
#include "study.hpp"

#include "quorient/fdi/sensor_class.hpp"

#include <vector>

namespace quorient::studies {

/// Everything that the study `field` measured.
struct FieldFigures {
    fdi::Mount mount = fdi::Mount::board;
    std::vector<LogFigures> sound;
    std::vector<LogFigures> faulty;
    std::vector<FaultFigures> faults;
};

Report field_report(const FieldFigures& figures);

}  // namespace quorient::studies
