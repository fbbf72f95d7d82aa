#pragma once

#include "quorient/diagnosis/report.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>

namespace quorient::diagnosis {

/// What is wrong, in words: "shows 0.47 +- 0.01 of the true rate and reads 10.7 deg/s too little".
std::string words_of(const Finding& finding);

/// "g0 z", "g0", "g0 or g1"; "g0 and g1" where they disagree.
std::string place_of(const Finding& finding, const Report& report);

/// "from 7.1 s to 12.0 s", "from 7.1 s on", "all the time".
std::string time_of(const Finding& finding, const Report& report);

/// Place, words and time: "g0 and g1 disagree from 7.10 s to 12.00 s".
std::string statement_of(const Finding& finding, const Report& report);

/// "90 degrees about z": the turn, in words. @param turn  a rotation
std::string words_of_turn(const Eigen::Matrix3d& turn);

/// With so many digits behind the point; what shows as 0 has no sign.
std::string fixed(double value, int digits);

/// "1 gap", "2 gaps".
std::string counted(std::uint64_t count, std::string_view thing);

}  // namespace quorient::diagnosis
