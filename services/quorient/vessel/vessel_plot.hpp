#pragma once

#include "cli/svg_plot.hpp"
#include "vessel_run.hpp"

#include <string>
#include <vector>

namespace quorient::cli {

/// As the paper's figures 4 (true and measured), 5 (each observer's residuals) and 6 (the metrics), and below them what was decided.
class VesselPlot {
public:
    VesselPlot(const std::string& scheme, std::size_t states, std::size_t channels);

    void add(const VesselRow& row);

    void write(OutputFile& file) const;

private:
    Chart motion_, samples_, metrics_, decisions_;
    std::vector<Chart> residuals_;  // by observer
};

}  // namespace quorient::cli
