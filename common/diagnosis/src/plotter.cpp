#include "plotter.hpp"

#include "rates.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::diagnosis {
namespace {

constexpr std::size_t bins = 900;

}  // namespace

Plotter::Plotter(std::size_t instruments, double first_s, double last_s) : instruments_(instruments), first_s_(first_s)
{
    plot_.first_s = first_s;
    plot_.bin_s = std::max(1e-3, (last_s - first_s) / bins);
    plot_.bins.resize(bins);
}

PlotBin& Plotter::bin_at(double time_s)
{
    const double place = std::clamp((time_s - first_s_) / plot_.bin_s, 0.0, bins - 1.0);
    return plot_.bins[static_cast<std::size_t>(place)];
}

void Plotter::add(double time_s, const Array& array, const recording::AlignedFrame& frame, const fdi::Assessment& assessment)
{
    PlotBin& bin = bin_at(time_s);
    if (!bin.filled) {
        bin.of.resize(instruments_);
        bin.filled = true;
    }
    for (std::size_t m = 0; m < instruments_; ++m) {
        if (!has_triad(frame, m)) continue;
        PlotBin::Instrument& one = bin.of[m];
        const Eigen::Vector3f rate = (array.common(frame, m) / degree).cast<float>();
        one.least_deg_s = one.frames == 0 ? rate : Eigen::Vector3f(one.least_deg_s.cwiseMin(rate));
        one.largest_deg_s = one.frames == 0 ? rate : Eigen::Vector3f(one.largest_deg_s.cwiseMax(rate));
        ++one.frames;
        for (std::size_t axis = 3 * m; axis < 3 * m + 3; ++axis) {
            const double scale = 1 / (frame.interval_s * degree);
            one.residual_deg_s = std::max(one.residual_deg_s, static_cast<float>(std::abs(assessment.residual[axis]) * scale));
            one.bound_deg_s = std::max(one.bound_deg_s, static_cast<float>(assessment.bound[axis] * scale));
        }
    }
}

void Plotter::add_attitude(double time_s, double with_deg, double alone_deg)
{
    PlotBin& bin = bin_at(time_s);
    bin.with_deg = static_cast<float>(with_deg);
    bin.alone_deg = static_cast<float>(alone_deg);
}

}  // namespace quorient::diagnosis
