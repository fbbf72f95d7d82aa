#include "quorient/calibration/axes_fit.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace quorient::calibration {
namespace {

using geometry::AxisMatrix;

constexpr double least_motion = 30.0;  // rms rate about the least turned body axis, in standard deviations of one sample at rest

}  // namespace

tl::expected<AxesFit, std::string> fit_axes(const std::vector<geometry::AxisVector>& unbiased_rates, const geometry::Axes& nominal,
                                            double noise_rad_s)
{
    const Eigen::Index n = nominal.rows();
    if (n < 4) return tl::unexpected(fmt::format("{} axes have no redundancy to compare each other by", n));
    if (unbiased_rates.empty()) return tl::unexpected(std::string("no sample of motion below saturation"));

    AxisMatrix moment = AxisMatrix::Zero(n, n);
    for (const auto& rate : unbiased_rates) moment += rate * rate.transpose();
    moment /= static_cast<double>(unbiased_rates.size());
    const Eigen::SelfAdjointEigenSolver<AxisMatrix> solver(moment);  // eigenvalues ascend
    // Of a cluster with H'H = (n/3) I, a body rate of variance s^2 about each axis has the eigenvalue n s^2 / 3.
    const double weakest_rad_s = std::sqrt(std::max(0.0, solver.eigenvalues()(n - 3)) * 3.0 / static_cast<double>(n));
    if (!(weakest_rad_s > least_motion * noise_rad_s))
        return tl::unexpected(fmt::format("the motion turned about one body axis with {:.4f} rad/s rms only; {:.4f} are needed",
                                          weakest_rad_s, least_motion * noise_rad_s));

    const geometry::Axes basis = solver.eigenvectors().rightCols<3>();
    geometry::Axes fitted = basis * (basis.transpose() * nominal);
    AxesFit fit;
    fit.samples = unbiased_rates.size();
    fit.gain = fitted.rowwise().norm();
    const double common = fit.gain.mean();
    fit.axes = fitted.array().colwise() / fit.gain.array();
    fit.gain /= common;
    // What the three directions do not hold is the disagreement.
    fit.residual_rad_s = std::sqrt(std::max(0.0, solver.eigenvalues().head(n - 3).sum()) / static_cast<double>(n - 3));
    return fit;
}

}  // namespace quorient::calibration
