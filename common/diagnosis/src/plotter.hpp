#pragma once

#include "array.hpp"

#include "quorient/diagnosis/report.hpp"
#include "quorient/fdi/detector.hpp"

namespace quorient::diagnosis {

/// Puts what is drawn into so many bins over the log's time.
class Plotter {
public:
    Plotter(std::size_t instruments, double first_s, double last_s);

    void add(double time_s, const Array& array, const recording::AlignedFrame& frame, const fdi::Assessment& assessment);
    void add_attitude(double time_s, double with_deg, double alone_deg);

    Plot take() { return std::move(plot_); }

private:
    PlotBin& bin_at(double time_s);

    std::size_t instruments_;
    double first_s_;
    Plot plot_;
};

}  // namespace quorient::diagnosis
