#pragma once

#include "overview.hpp"

#include "quorient/recording/survey.hpp"

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace quorient::diagnosis {

/// How the compared instruments stand to each other: what the whole log shows, not what a part of it shows.
struct Mountings {
    struct One {
        Eigen::Matrix3d nominal = Eigen::Matrix3d::Identity();  ///< by the log: takes its axes' components to those of the body
        Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();   ///< as it really measures: to those of the common frame
        bool odd = false;      ///< one log's instruments should be parallel as the log states, and this one is not
        double scale = 1;      ///< its numbers are so many times too large: a wrong unit
    };
    std::vector<One> of;
    bool majority = false;       ///< more than half of the instruments are parallel: the odd ones are to blame
    bool unit_majority = false;  ///< likewise of the units
};

/// Right-angle turns first, then any turn that is large, clear, and holds in nearly all of the log. Instruments of separate logs stand as
/// they like: all their turns are fitted, and none is odd.
Mountings find_mountings(const Overview& overview, const std::vector<recording::SurveyedInstrument>& instruments);

/// By the log's own statement: takes the instrument's components to those of the body.
Eigen::Matrix3d nominal_mounting(const recording::Instrument& instrument);

}  // namespace quorient::diagnosis
