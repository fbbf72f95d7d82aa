#pragma once

#include "array.hpp"

#include "quorient/diagnosis/ardupilot_rule.hpp"
#include "quorient/diagnosis/px4_rule.hpp"
#include "quorient/diagnosis/report.hpp"

#include <string>
#include <vector>

namespace quorient::diagnosis {

/// The published rules of other autopilots, on the log as it is: mountings by the log's own statement.
class Peers {
public:
    /// @param overview  for the first rest: both autopilots know their gyros' biases from there
    Peers(const Overview& overview, const std::vector<recording::SurveyedInstrument>& instruments, double interval_s);

    void add(const recording::AlignedFrame& frame);

    std::vector<PeerFinding> findings(const std::vector<std::string>& names) const;

private:
    Array as_logged_;
    Px4Rule px4_;
    ArduPilotRule ardupilot_;
    std::vector<Eigen::Vector3d> bias_rad_s_;
    double rest_until_s_ = 0;  ///< 0: the log begins in motion
    std::optional<std::size_t> px4_blames_;
    double px4_at_s_ = 0;
    bool px4_ran_ = false;
};

}  // namespace quorient::diagnosis
