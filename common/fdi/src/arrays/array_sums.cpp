#include "quorient/fdi/array_sums.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace quorient::fdi {
namespace {

/// A blow: in the frame in which a motion begins the acceleration is larger than its mean over the frame shows, its square by up to
/// this (and one). Bounds the knocks between the poses of the MIMU4444 recordings.
constexpr double blow_excess = 16;

/// How fast the memory of a wild moment fades, per frame.
constexpr double calming = 1.0 / 16;

/// Share of the roughness that lowers a frame's weight: most frames are not the outliers that it stands for.
constexpr double roughness_in_weight = 0.03;

}  // namespace

ArraySums::ArraySums(const InstrumentArray& array, const MotionNoise& motion, std::optional<double> gate)
    : array_(array),
      motion_(motion),
      gate_(gate),
      scale_(3 / array.mean_information().trace()),
      totals_(history_length),
      roughness_(history_length)
{
    for (Totals& totals : totals_) {
        totals.sum.setZero(3, static_cast<Eigen::Index>(array.size()));
        totals.own.fill(Eigen::Matrix3d::Zero());
    }
}

void ArraySums::exclude(AxisMask excluded)
{
    array_.exclude(excluded);
    pending_.reset();
}

void ArraySums::reset()
{
    size_ = 0;
    near_range_ = 0;
    near_range_before_ = 0;
    wildness_ = 0;
    pending_.reset();
}

ArraySums::Added ArraySums::add(const Measurement& measurement)
{
    near_range_before_ = near_range_;
    near_range_ = 0;
    if (!(measurement.interval_s > 0) || !array_.complete(measurement)) {
        pending_.reset();
        return Added::unusable;
    }
    near_range_ = array_.near_range(measurement);
    Pending newest = pending_of(measurement);
    const bool followed = pending_.has_value();
    if (followed) {
        newest.acceleration_before = (newest.rate - pending_->rate) / measurement.interval_s;
        count_in(*pending_, newest.acceleration_before);
    }
    pending_ = newest;
    return followed ? Added::counted : Added::waits;
}

ArraySums::Pending ArraySums::pending_of(const Measurement& measurement) const
{
    Pending frame;
    frame.sequence = measurement.identity.sequence;
    frame.interval_s = measurement.interval_s;
    frame.saturated = saturated();
    frame.body = array_.body_vectors(measurement);
    frame.rate = frame.body.rowwise().sum() / (measurement.interval_s * static_cast<double>(array_.compared_count()));
    return frame;
}

Eigen::Matrix3d ArraySums::motion_covariance(const Pending& frame, const Eigen::Vector3d& acceleration_after, double blow,
                                             double rough) const
{
    const Eigen::Vector3d& a = frame.acceleration_before;
    const Eigen::Vector3d& b = acceleration_after;
    const double h = frame.interval_s;
    const double along = motion_.jitter_along_s * motion_.jitter_along_s;
    const double across = motion_.jitter_across_s * motion_.jitter_across_s;
    const Eigen::Matrix3d spread = h * h * (a * a.transpose() + b * b.transpose()) / 2;
    const double outliers = roughness_in_weight * motion_.roughness_s * motion_.roughness_s * rough;
    return blow * (along - across) * spread + (blow * across * spread.trace() + outliers) * Eigen::Matrix3d::Identity();
}

/// How much of a frame counts. `information`: (C + M_k)^-1.
double ArraySums::share_of(const Pending& frame, const Eigen::Matrix3d& information) const
{
    if (!gate_ || array_.compared_count() < 2) return 1;
    const auto count = static_cast<double>(array_.compared_count());
    const Eigen::Vector3d mean = frame.body.rowwise().sum() / count;  // who is not compared has 0
    double largest = 0;
    for (std::size_t m = 0; m < array_.size(); ++m) {
        if (!array_.compared(m)) continue;
        const Eigen::Vector3d deviation = frame.body.col(static_cast<Eigen::Index>(m)) - mean;
        largest = std::max(largest, deviation.dot(information * deviation) * count / (count - 1));
    }
    return std::min(1.0, *gate_ / largest);
}

void ArraySums::count_in(const Pending& frame, const Eigen::Vector3d& acceleration_after)
{
    const double h = frame.interval_s;
    const double squared = std::max(frame.acceleration_before.squaredNorm(), acceleration_after.squaredNorm());
    const double blow = squared > wildness_ ? 1 + blow_excess * (1 - wildness_ / squared) : 1;
    // Where the acceleration passes through zero the errors do not: they follow how wild the motion has been lately.
    wildness_ = std::max(squared * blow, wildness_ + (squared - wildness_) * calming);
    const double rough = h * h * wildness_;
    const Eigen::Matrix3d moving = motion_covariance(frame, acceleration_after, blow, rough) + array_.blindness(frame.saturated, h);
    const Eigen::Matrix3d information = (array_.mean_covariance() + moving).inverse();
    const Eigen::Matrix3d weight = scale_ * share_of(frame, information) * information;
    const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>().computeDirect(weight, Eigen::EigenvaluesOnly).eigenvalues()(2);

    const Totals& before = total(0);
    Totals& now = totals_[next_];
    now.sum = before.sum + weight * frame.body;
    now.weight = before.weight + weight;
    now.biased = before.biased + weight * h;
    now.turned = before.turned + weight * (frame.rate.norm() * h);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const auto j = static_cast<std::size_t>(axis);
        now.rotated[j] = before.rotated[j] + weight * (frame.rate(axis) * h);
    }
    for (std::size_t m = 0; m < array_.size(); ++m)
        if (array_[m].kind == m) now.own[m] = before.own[m] + weight * (array_[m].covariance - array_.mean_covariance()) * weight;
    roughness_[next_] = largest * largest * rough;
    now.sequence = frame.sequence;
    next_ = (next_ + 1) % history_length;
    size_ = std::min(size_ + 1, history_length);
    ++count_;
}

Eigen::Matrix3d ArraySums::common_covariance(std::size_t window) const
{
    const Totals& newest = total(0);
    const Totals& oldest = total(window);
    const Eigen::Matrix3d constant =
        motion_.bias_floor_rad_s * (newest.biased - oldest.biased) + motion_.rate_error * (newest.turned - oldest.turned);
    double roughest = 0;
    for (std::size_t age = 0; motion_.roughness_s > 0 && age < window; ++age) roughest = std::max(roughest, roughness_[place(age)]);
    const double outlier = motion_.roughness_s * motion_.roughness_s * roughest;
    Eigen::Matrix3d floors = constant * constant.transpose();
    for (std::size_t j = 0; j < 3; ++j) {
        const Eigen::Matrix3d rotated = motion_.axes_error * (newest.rotated[j] - oldest.rotated[j]);
        floors += rotated * rotated.transpose();
    }
    return scale_ * (newest.weight - oldest.weight) + floors + outlier * Eigen::Matrix3d::Identity();
}

ArraySums::Contradiction ArraySums::Fit::contradiction(std::size_t instrument) const
{
    const Eigen::Matrix3d& own = information[instrument];
    return {.u = own * (value[instrument] - fused), .q = own - own * covariance * own};
}

double ArraySums::Fit::chi_square(std::size_t instrument) const
{
    const Eigen::Vector3d deviation = value[instrument] - fused;
    return deviation.dot(contrast[instrument] * deviation);
}

ArraySums::Fit ArraySums::fit(std::size_t window) const
{
    const Totals& newest = total(0);
    const Totals& oldest = total(window);
    const Eigen::Matrix3d common = common_covariance(window);

    Fit fit;
    fit.weight = newest.weight - oldest.weight;
    Eigen::Matrix3d total_information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d total_value = Eigen::Vector3d::Zero();
    std::array<Eigen::Matrix3d, InstrumentArray::max_instruments> own;  // R_m of a kind
    for (std::size_t m = 0; m < array_.size(); ++m) {
        const std::size_t kind = array_[m].kind;
        if (kind == m) own[m] = common + newest.own[m] - oldest.own[m];
        fit.information[m] = kind == m ? Eigen::Matrix3d(own[m].inverse()) : fit.information[kind];
        if (!array_.compared(m)) continue;
        const auto column = static_cast<Eigen::Index>(m);
        fit.value[m] = newest.sum.col(column) - oldest.sum.col(column);
        total_information += fit.information[m];
        total_value += fit.information[m] * fit.value[m];
    }
    fit.covariance = total_information.inverse();
    fit.fused = fit.covariance * total_value;
    for (std::size_t m = 0; m < array_.size(); ++m) {
        const std::size_t kind = array_[m].kind;
        fit.contrast[m] = kind == m ? Eigen::Matrix3d((own[m] - fit.covariance).inverse()) : fit.contrast[kind];
    }
    return fit;
}

double ArraySums::largest_chi_square(std::size_t window) const
{
    const Fit over = fit(window);
    double largest = 0;
    for (std::size_t m = 0; m < array_.size(); ++m)
        if (array_.compared(m)) largest = std::max(largest, over.chi_square(m));
    return largest;
}

}  // namespace quorient::fdi
