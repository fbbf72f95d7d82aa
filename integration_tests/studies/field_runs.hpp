#pragma once

#include "field_figures.hpp"
#include "field_log.hpp"
#include "monte_carlo.hpp"

#include "field/field_detector.hpp"

#include <span>
#include <vector>

namespace quorient::studies {

/// Every log with each of its sets of instruments. @throws std::runtime_error naming what cannot be read.
std::vector<FieldLog> load_field_logs(const std::vector<std::filesystem::path>& files);

/// Every log as it is.
std::vector<LogFigures> play_logs(const std::vector<FieldLog>& logs, const RunSettings& settings, const fdi::FieldRules& rules = {});

/// Every fault in every log of three instruments or more, settings.trials times. The trials are the same whatever the rules.
std::vector<FaultFigures> inject_faults(const std::vector<FieldLog>& logs, const RunSettings& settings, const OnProgress& on_progress,
                                        const fdi::FieldRules& rules = {});

}  // namespace quorient::studies
