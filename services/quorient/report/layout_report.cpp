#include "layout_report.hpp"

#include "cli/json_output.hpp"
#include "quorient/geometry/figures.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <fmt/format.h>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

namespace quorient::cli {

namespace {

struct LayoutFigures {
    geometry::Axes axes;
    std::vector<std::size_t> axis, instrument;
    geometry::Accuracy accuracy{Eigen::Vector3d::Constant(undefined), undefined, undefined, undefined};
    double minimum_angle_deg = undefined;
    geometry::AxisMatrix parity_matrix, parity_equations, isolation_index;
    geometry::AxisVector detection_index;
    double f_d1 = undefined, f_d2 = undefined, f_d2_partner_excluded = undefined;
    unsigned detectable = 0, isolable = 0;
};

LayoutFigures report_on(const geometry::SensorCluster& cluster, AxisMask used)
{
    LayoutFigures report;
    report.axes = geometry::select(cluster.axes, used);
    for (std::size_t axis = 0; axis < cluster.size(); ++axis)
        if (has_axis(used, axis)) {
            report.axis.push_back(axis);
            report.instrument.push_back(cluster.instrument[axis]);
        }

    const geometry::ParitySpace space(report.axes);
    if (const auto accuracy = geometry::accuracy(report.axes)) report.accuracy = *accuracy;
    if (const auto angle = geometry::minimum_angle_rad(report.axes)) report.minimum_angle_deg = *angle * 180 / std::numbers::pi;
    report.parity_matrix = geometry::parity_matrix(space);
    report.parity_equations = geometry::parity_equations(space);
    report.isolation_index = geometry::isolation_index(report.parity_equations);
    report.detection_index = geometry::detection_index(space);
    report.f_d1 = geometry::f_d1(space);
    report.f_d2 = geometry::f_d2(space);
    report.f_d2_partner_excluded = geometry::f_d2_partner_excluded(report.axes, report.instrument).value_or(undefined);
    report.detectable = geometry::detectable_with(report.axes);
    report.isolable = geometry::isolable_with(report.axes);
    return report;
}

std::string report_cell(double value)
{
    return std::isfinite(value) ? fmt::format("{:>10.6f}", value) : fmt::format("{:>10}", "-");
}

template <class Derived>
void append_matrix(std::string& text, std::string_view title, const Eigen::DenseBase<Derived>& matrix)
{
    fmt::format_to(std::back_inserter(text), "{}\n", title);
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        for (Eigen::Index column = 0; column < matrix.cols(); ++column) text += report_cell(matrix.derived().coeff(row, column));
        text += '\n';
    }
}

}  // namespace

Json layout_json(const std::string& name, const geometry::SensorCluster& cluster, AxisMask used)
{
    const LayoutFigures report = report_on(cluster, used);
    Json json;
    json["name"] = name;
    json["axes"] = matrix_json(report.axes);
    if (used != cluster.all()) json["axis"] = report.axis;
    json["instrument"] = report.instrument;
    json["eigenvalues"] = vector_json(report.accuracy.eigenvalues);
    json["trace"] = report.accuracy.trace;
    json["volume"] = report.accuracy.volume;
    json["condition"] = report.accuracy.condition;
    json["minimum_angle_deg"] = report.minimum_angle_deg;
    json["parity_matrix"] = matrix_json(report.parity_matrix);
    json["parity_per_axis"] = matrix_json(report.parity_equations);
    json["J"] = vector_json(report.detection_index);
    json["J_ij"] = matrix_json(report.isolation_index);
    json["F_d1"] = report.f_d1;
    json["F_d2"] = report.f_d2;
    json["F_d2_partner_excluded"] = report.f_d2_partner_excluded;
    json["detectable"] = report.detectable;
    json["isolable"] = report.isolable;
    return json;
}

std::string layout_text(const std::string& name, const geometry::SensorCluster& cluster, AxisMask used)
{
    const LayoutFigures report = report_on(cluster, used);
    std::string text = fmt::format("{}: {} axes\n", name, report.axes.rows());
    fmt::format_to(std::back_inserter(text), "{:>4} {:>10} {:>10}{:>10}{:>10}\n", "axis", "instrument", "x", "y", "z");
    for (std::size_t row = 0; row < report.axis.size(); ++row) {
        const auto axis = report.axes.row(static_cast<Eigen::Index>(row));
        fmt::format_to(std::back_inserter(text), "{:>4} {:>10} {}{}{}\n", report.axis[row], report.instrument[row], report_cell(axis(0)),
                       report_cell(axis(1)), report_cell(axis(2)));
    }

    fmt::format_to(std::back_inserter(text), "\naccuracy, (H'H)^-1 for unit noise\n  eigenvalues {}{}{}\n",
                   report_cell(report.accuracy.eigenvalues(0)), report_cell(report.accuracy.eigenvalues(1)),
                   report_cell(report.accuracy.eigenvalues(2)));
    fmt::format_to(std::back_inserter(text), "  trace       {}\n  volume      {}\n  condition   {}\n", report_cell(report.accuracy.trace),
                   report_cell(report.accuracy.volume), report_cell(report.accuracy.condition));
    fmt::format_to(std::back_inserter(text), "smallest angle between axes, as lines {} deg\n\n", report_cell(report.minimum_angle_deg));

    append_matrix(text, "parity matrix V, minimal set (eq. 8)", report.parity_matrix);
    append_matrix(text, "J of the minimal set", report.detection_index.transpose());
    append_matrix(text, "\nparity equations, one per axis", report.parity_equations);
    append_matrix(text, "J of the parity equations", report.isolation_index);
    fmt::format_to(std::back_inserter(text), "\nF_d1 {}\nF_d2 {}\nF_d2, partner axes excluded {}\n", report_cell(report.f_d1),
                   report_cell(report.f_d2), report_cell(report.f_d2_partner_excluded));
    fmt::format_to(std::back_inserter(text), "simultaneous axis faults of any size: {} detectable, {} isolable from one sample\n",
                   report.detectable, report.isolable);
    return text;
}

}  // namespace quorient::cli
