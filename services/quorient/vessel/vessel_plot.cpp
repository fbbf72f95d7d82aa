#include "vessel_plot.hpp"

#include <fmt/format.h>

namespace quorient::cli {

namespace {

Chart labelled(const std::string& title, const std::string& y_label)
{
    Chart chart;
    chart.title = title;
    chart.x_label = "time, s";
    chart.y_label = y_label;
    return chart;
}

void extend(Chart& chart, double time_s, const Eigen::VectorXd& values)
{
    for (std::size_t k = 0; k < chart.series.size(); ++k) chart.series[k].points.emplace_back(time_s, values(static_cast<Eigen::Index>(k)));
}

}  // namespace

VesselPlot::VesselPlot(const std::string& scheme, std::size_t states, std::size_t channels)
    : motion_(labelled("The motion (paper 001, Fig. 4a)", "state")),
      samples_(labelled("What the sensors say (Fig. 4b)", "sample")),
      metrics_(labelled("Metrics of the " + scheme + " scheme (Fig. 6)", "metric")),
      decisions_(labelled("Isolated", "channel"))
{
    for (std::size_t k = 0; k < states; ++k) motion_.series.push_back({fmt::format("state {}", k), {}, colour(k)});
    for (std::size_t k = 0; k < channels; ++k) {
        const auto name = fmt::format("channel {}", k);
        samples_.series.push_back({name, {}, colour(k)});
        metrics_.series.push_back({name, {}, colour(k)});
        decisions_.series.push_back({name, {}, colour(k), false});
        residuals_.push_back(labelled(fmt::format("Residuals of the observer of channel {} (Fig. 5)", k), "residual"));
        for (std::size_t j = 0; j < channels; ++j) residuals_.back().series.push_back({fmt::format("channel {}", j), {}, colour(j)});
    }
}

void VesselPlot::add(const VesselRow& row)
{
    extend(motion_, row.time_s, row.state);
    extend(samples_, row.time_s, row.sample);
    for (std::size_t k = 0; k < residuals_.size(); ++k) {
        extend(residuals_[k], row.time_s, row.residual[k]);
        metrics_.series[k].points.emplace_back(row.time_s, row.metric[k]);
        if (has_axis(row.assessment.isolated, k)) decisions_.series[k].points.emplace_back(row.time_s, static_cast<double>(k));
    }
}

void VesselPlot::write(OutputFile& file) const
{
    std::vector<Chart> charts{motion_, samples_};
    charts.insert(charts.end(), residuals_.begin(), residuals_.end());
    charts.insert(charts.end(), {metrics_, decisions_});
    write_svg(file, charts);
}

}  // namespace quorient::cli
