#include "quorient/calibration/axes_fit.hpp"

#include "quorient/geometry/triads.hpp"
#include "quorient/rotation/nearest.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace quorient::calibration {
namespace {

using geometry::AxisMatrix;

constexpr double least_motion_to_disagreement = 5.0;  // the weakest motion to the strongest disagreement, both as rms rates
constexpr double nominal_enough = 0.175;  // [rad] 10 deg: no assembly error is larger, no deliberate mounting smaller

/// Which rows of H belong to each instrument.
std::vector<std::vector<Eigen::Index>> rows_of_instruments(const std::vector<std::size_t>& instrument)
{
    std::vector<std::vector<Eigen::Index>> rows(*std::max_element(instrument.begin(), instrument.end()) + 1);
    for (std::size_t axis = 0; axis < instrument.size(); ++axis) rows[instrument[axis]].push_back(static_cast<Eigen::Index>(axis));
    return rows;
}

}  // namespace

tl::expected<AxesFit, std::string> fit_axes(const RateMoment& motion, const geometry::Axes& nominal)
{
    const Eigen::Index n = nominal.rows();
    if (n < 4) return tl::unexpected(fmt::format("{} axes have no redundancy to compare each other by", n));
    if (motion.samples() == 0) return tl::unexpected(std::string("no sample of motion below saturation"));

    const AxisMatrix moment = motion.sum() / static_cast<double>(motion.samples());
    const Eigen::SelfAdjointEigenSolver<AxisMatrix> solver(moment);  // eigenvalues ascend
    const double weakest_motion = std::sqrt(std::max(0.0, solver.eigenvalues()(n - 3)));
    const double disagreement = std::sqrt(std::max(0.0, solver.eigenvalues()(n - 4)));
    if (!(weakest_motion > least_motion_to_disagreement * disagreement))
        return tl::unexpected(
            fmt::format("the motion about one body axis is {:.4f} rad/s rms only, the axes disagree by {:.4f}; {} times that is needed",
                        weakest_motion, disagreement, least_motion_to_disagreement));

    const geometry::Axes basis = solver.eigenvectors().rightCols<3>();
    const geometry::Axes fitted = basis * (basis.transpose() * nominal);
    AxesFit fit;
    fit.samples = motion.samples();
    const Eigen::VectorXd length = fitted.rowwise().norm();
    fit.axes = fitted.array().colwise() / length.array();
    fit.gain = length / length.mean();
    // What the three directions do not hold is the disagreement.
    fit.residual_rad_s = std::sqrt(std::max(0.0, solver.eigenvalues().head(n - 3).sum()) / static_cast<double>(n - 3));
    return fit;
}

geometry::Axes turned(const geometry::Axes& nominal, const std::vector<std::size_t>& instrument, const std::vector<Eigen::Matrix3d>& to_first)
{
    geometry::Axes axes = nominal;
    for (std::size_t axis = 0; axis < instrument.size(); ++axis) {
        const Eigen::Matrix3d& turn = to_first[instrument[axis]];
        const auto row = static_cast<Eigen::Index>(axis);
        if (Eigen::AngleAxisd(turn).angle() >= nominal_enough) axes.row(row) = nominal.row(row) * turn.transpose();
    }
    return axes;
}

geometry::Axes mounted(const RateMoment& motion, const geometry::Axes& nominal, const std::vector<std::size_t>& instrument)
{
    const auto rows = rows_of_instruments(instrument);
    const auto body_from = [&nominal](const std::vector<Eigen::Index>& own) { return geometry::least_squares_inverse(nominal(own, Eigen::all)); };
    const auto first = body_from(rows.front());
    std::vector<Eigen::Matrix3d> to_first(rows.size(), Eigen::Matrix3d::Identity());
    for (std::size_t i = 1; i < rows.size() && first; ++i) {
        const auto own = body_from(rows[i]);
        if (own) to_first[i] = rotation::nearest_rotation(*first * motion.sum()(rows.front(), rows[i]) * own->transpose());
    }
    return turned(nominal, instrument, to_first);
}

}  // namespace quorient::calibration
