#pragma once

#include "cli/json_output.hpp"
#include "quorient/calibration/calibration.hpp"
#include "quorient/calibration/motion_level.hpp"
#include "quorient/calibration/silence.hpp"
#include "quorient/recording/reader.hpp"
#include "cli/svg_plot.hpp"

#include <optional>
#include <string>
#include <vector>

namespace quorient::cli {

/// What the searches ended with that were made with a calibration.
struct Searches {
    std::optional<calibration::MotionLevel> level;
    std::optional<calibration::Silence> silence;
};

Json calibration_json(const calibration::Calibration& calibration, const Searches& searches, calibration::Samples samples,
                      const recording::Statistics& statistics);

std::string calibration_text(const calibration::Calibration& calibration, const Searches& searches, calibration::Samples samples,
                             const recording::Statistics& statistics);

/// Allan deviation of every axis; disagreement over angular acceleration where the motion showed it.
std::vector<Chart> calibration_charts(const calibration::Calibration& calibration);

}  // namespace quorient::cli
