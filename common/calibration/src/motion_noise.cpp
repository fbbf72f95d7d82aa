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
class WindowSums {
public:
    explicit WindowSums(std::size_t frames) : result_{frames, 0, 0} {}

    /// The next sample's residual. Nothing: the sample does not count, and breaks a window, as one that does not follow does.
    void add(const std::optional<AxisVector>& residual, bool follows)
    {
        if (!residual || !follows) count_ = 0;
        if (!residual) return;
        if (count_ == 0) sum_ = *residual;
        else sum_ += *residual;
        if (++count_ < result_.frames) return;
        squares_ += (sum_ / static_cast<double>(count_)).squaredNorm() / static_cast<double>(sum_.size());
        ++result_.windows;
        count_ = 0;
    }

    WindowResidual result() const
    {
        WindowResidual result = result_;
        if (result.windows > 0) result.residual_rad_s = std::sqrt(squares_ / static_cast<double>(result.windows));
        return result;
    }

private:
    WindowResidual result_;
    AxisVector sum_;
    std::size_t count_ = 0;
    double squares_ = 0;
};

/// The disagreement at each level of angular acceleration.
class Bins {
public:
    void add(double acceleration, const AxisVector& scaled)
    {
        const auto bin = static_cast<std::size_t>(std::log10(acceleration / least_acceleration_rad_s2) * bins_per_decade);
        if (bin >= bins_.size()) bins_.resize(bin + 1);
        bins_[bin].acceleration += acceleration;
        bins_[bin].squares += scaled.squaredNorm() / static_cast<double>(scaled.size());
        ++bins_[bin].samples;
    }

    std::vector<DisagreementBin> result() const
    {
        std::vector<DisagreementBin> result;
        for (const BinSums& bin : bins_) {
            if (bin.samples == 0) continue;
            const auto count = static_cast<double>(bin.samples);
            result.push_back({bin.acceleration / count, std::sqrt(bin.squares / count), bin.samples});
        }
        return result;
    }

private:
    std::vector<BinSums> bins_;
};

/// A sample between its neighbours, with the rates of all three.
struct Neighbours {
    Sample before, here, after;
    AxisVector rate_before, rate, rate_after;

    void advance(Sample next, const RateOf& rate_of)
    {
        before = std::move(here);
        here = std::move(after);
        after = std::move(next);
        rate_before = std::move(rate);
        rate = std::move(rate_after);
        rate_after = rate_of(after);
    }
};

}  // namespace

MotionFigures motion_figures(Samples samples, const RateOf& rate_of, const std::vector<bool>& usable, const geometry::Axes& axes,
                             const AxisVector& deviation)
{
    const auto project = projectors(axes);
    const AxisVector share = project.residual.diagonal();  // share of an axis's own error that its residual shows
    NoiseEquations equations;
    Bins bins;
    std::vector<WindowSums> windows(window_frames.begin(), window_frames.end());
    MotionFigures figures;
    Neighbours near;
    for (std::size_t i = 0; i < std::min<std::size_t>(2, samples.size()); ++i) near.advance(samples[i], rate_of);
    for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
        near.advance(samples[i + 1], rate_of);
        std::optional<AxisVector> moving;
        const bool whole = usable[i - 1] && usable[i] && usable[i + 1] && near.here.follows && near.after.follows;
        const Eigen::Vector3d acceleration =
            project.body * (near.rate_after - near.rate_before) / (near.here.interval_s + near.after.interval_s);
        const double size = acceleration.norm();
        if (whole && size >= least_acceleration_rad_s2) {
            const AxisVector residual = project.residual * near.rate;
            moving = residual.array() / share.array().sqrt();
            equations.add(moving->cwiseAbs2() - deviation.cwiseAbs2(), axes, acceleration);
            bins.add(size, *moving);
            ++figures.noise.samples;
            figures.noise.largest_acceleration_rad_s2 = std::max(figures.noise.largest_acceleration_rad_s2, size);
        }
        for (WindowSums& window : windows) window.add(moving, near.here.follows);
    }
    if (figures.noise.samples > 0) {
        const SamplingJitter solved = equations.solve();
        figures.noise.along_s = solved.along_s;
        figures.noise.across_s = solved.across_s;
    }
    figures.bins = bins.result();
    for (const WindowSums& window : windows) figures.windows.push_back(window.result());
    return figures;
}

}  // namespace quorient::calibration
