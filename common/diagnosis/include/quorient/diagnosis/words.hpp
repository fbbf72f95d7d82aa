#pragma once

#include "quorient/diagnosis/report.hpp"

#include <string>

namespace quorient::diagnosis {

/// What is wrong, in words: "z axis shows 0.47 +- 0.01 of the true rate and -10.7 deg/s too much".
std::string words_of(const Finding& finding);

/// "g0 z", "g0", "g0 or g1".
std::string place_of(const Finding& finding, const Report& report);

/// "from 7.1 s to 12.0 s", "from 7.1 s on", "all the time".
std::string time_of(const Finding& finding, const Report& report);

}  // namespace quorient::diagnosis
