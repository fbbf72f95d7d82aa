#include "quorient/calibration/motion_noise.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace quorient::calibration {
namespace {

using geometry::AxisMatrix;
using geometry::AxisVector;

constexpr double least_acceleration_rad_s2 = 50.0;  // below it the noise at rest hides the motion's share
constexpr std::array<std::size_t, 5> window_frames{1, 4, 16, 64, 256};
constexpr std::size_t bins_per_decade = 8;

struct Projectors {
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, static_cast<int>(max_axes)> body;  // (H'H)^-1 H'
    AxisMatrix residual;                                                              // I - H (H'H)^-1 H'
};

Projectors projectors(const geometry::Axes& axes)
{
    Projectors result;
    result.body = (axes.transpose() * axes).inverse() * axes.transpose();
    result.residual = AxisMatrix::Identity(axes.rows(), axes.rows()) - axes * result.body;
    return result;
}

/// Least squares for along^2 and across^2 with rows of weight 1 / |a|^2: every sample then counts by its share of the rotation.
struct NoiseEquations {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();

    void add(const AxisVector& excess, const geometry::Axes& axes, const Eigen::Vector3d& acceleration)
    {
        const double squared = acceleration.squaredNorm();
        for (Eigen::Index i = 0; i < excess.size(); ++i) {
            const double along = std::pow(axes.row(i).dot(acceleration), 2);
            const Eigen::Vector2d row(along, squared - along);
            normal += row * row.transpose() / squared;
            right += row * excess(i) / squared;
        }
    }

    SamplingJitter solve() const
    {
        const Eigen::Vector2d squares = normal.fullPivLu().solve(right);
        SamplingJitter noise;
        noise.along_s = std::sqrt(std::max(0.0, squares(0)));
        noise.across_s = std::sqrt(std::max(0.0, squares(1)));
        return noise;
    }
};

struct BinSums {
    double acceleration = 0;
    double squares = 0;
    std::size_t samples = 0;
};

/// rms of the mean residual over windows without a break; the windows do not overlap.
WindowResidual over_windows(std::size_t frames, Samples samples, const std::vector<std::optional<AxisVector>>& residual)
{
    WindowResidual result{frames, 0, 0};
    double squares = 0;
    for (std::size_t begin = 0; begin + frames <= samples.size();) {
        AxisVector sum;
        std::size_t i = begin;
        for (; i < begin + frames && residual[i] && (i == begin || samples[i].follows); ++i) {
            if (i == begin) sum = *residual[i];
            else sum += *residual[i];
        }
        if (i == begin + frames) {
            squares += (sum / static_cast<double>(frames)).squaredNorm() / static_cast<double>(sum.size());
            ++result.windows;
        }
        begin = std::max(i, begin + 1);
    }
    if (result.windows > 0) result.residual_rad_s = std::sqrt(squares / static_cast<double>(result.windows));
    return result;
}

}  // namespace

MotionFigures motion_figures(Samples samples, const std::vector<AxisVector>& rates, const std::vector<bool>& usable,
                             const geometry::Axes& axes, const AxisVector& deviation)
{
    const auto project = projectors(axes);
    const AxisVector share = project.residual.diagonal();  // share of an axis's own error that its residual shows
    std::vector<std::optional<AxisVector>> moving(samples.size());
    NoiseEquations equations;
    std::vector<BinSums> bins;
    MotionFigures figures;
    for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
        const bool neighbours = usable[i - 1] && usable[i] && usable[i + 1] && samples[i].follows && samples[i + 1].follows;
        if (!neighbours) continue;
        const Eigen::Vector3d acceleration =
            project.body * (rates[i + 1] - rates[i - 1]) / (samples[i].interval_s + samples[i + 1].interval_s);
        const double size = acceleration.norm();
        if (size < least_acceleration_rad_s2) continue;
        const AxisVector residual = project.residual * rates[i];
        const AxisVector scaled = residual.array() / share.array().sqrt();
        equations.add(scaled.cwiseAbs2() - deviation.cwiseAbs2(), axes, acceleration);
        moving[i] = scaled;
        ++figures.noise.samples;

        const auto bin = static_cast<std::size_t>(std::log10(size / least_acceleration_rad_s2) * bins_per_decade);
        if (bin >= bins.size()) bins.resize(bin + 1);
        bins[bin].acceleration += size;
        bins[bin].squares += scaled.squaredNorm() / static_cast<double>(scaled.size());
        ++bins[bin].samples;
        figures.noise.largest_acceleration_rad_s2 = std::max(figures.noise.largest_acceleration_rad_s2, size);
    }
    if (figures.noise.samples > 0) {
        const SamplingJitter solved = equations.solve();
        figures.noise.along_s = solved.along_s;
        figures.noise.across_s = solved.across_s;
    }
    for (const BinSums& bin : bins) {
        if (bin.samples == 0) continue;
        const auto count = static_cast<double>(bin.samples);
        figures.bins.push_back({bin.acceleration / count, std::sqrt(bin.squares / count), bin.samples});
    }
    for (const std::size_t frames : window_frames) figures.windows.push_back(over_windows(frames, samples, moving));
    return figures;
}

}  // namespace quorient::calibration
