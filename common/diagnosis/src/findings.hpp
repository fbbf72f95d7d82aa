#pragma once

#include "aftermath.hpp"
#include "mounting.hpp"
#include "overview.hpp"
#include "watch.hpp"

#include "quorient/diagnosis/report.hpp"
#include "quorient/recording/survey.hpp"

#include <string>
#include <vector>

namespace quorient::diagnosis {

/// What the findings are made of. Instruments are numbered as compared.
struct Evidence {
    const Overview& overview;
    const Mountings& mountings;
    const Watch& watch;
    const Aftermath& aftermath;
    const std::vector<recording::SurveyedInstrument>& instruments;
};

/// All findings, the weightiest first, with instruments numbered as compared.
std::vector<Finding> findings_of(const Evidence& evidence);

/// Time stamps that step back in some instruments and not in all: the log's own clock is not to blame.
std::vector<Finding> findings_of_times(const std::vector<recording::SurveyedInstrument>& instruments);

/// Axes whose values show that they were at the end of their range, again and again.
std::vector<Finding> findings_of_ranges(const recording::Survey& survey, const std::vector<recording::SurveyedInstrument>& instruments);

/// Turned, wrong unit, without data: what shows without a detector.
std::vector<Finding> findings_of_setup(const Overview& overview, const Mountings& mountings);

}  // namespace quorient::diagnosis
