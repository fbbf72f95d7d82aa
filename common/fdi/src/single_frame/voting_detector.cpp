#include "single_frame/voting_detector.hpp"

#include "single_frame/combinations.hpp"
#include "single_frame/exact_pattern.hpp"
#include "quorient/fdi/noise.hpp"
#include "quorient/geometry/parity_space.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>

namespace quorient::fdi {

namespace {

/// Where the axis enters the estimate of the triad: a column of H_T^-1, or zero.
Eigen::Vector3d influence(const geometry::Triad& triad, std::size_t axis)
{
    for (std::size_t k = 0; k < 3; ++k)
        if (triad.axis[k] == axis) return triad.body_from_axes.col(static_cast<Eigen::Index>(k));
    return Eigen::Vector3d::Zero();
}

/// The axes whose error moves the difference of the two estimates.
AxisMask read_by(const geometry::Triad& first, const geometry::Triad& second)
{
    constexpr double negligible = 1e-9;  // beside columns of norm one and more
    AxisMask reads = first.mask() ^ second.mask();
    for (const std::size_t axis : first.axis)
        if (has_axis(second.mask(), axis) && (influence(first, axis) - influence(second, axis)).norm() > negligible)
            reads |= axis_bit(axis);
    return reads;
}

}  // namespace

tl::expected<std::unique_ptr<VotingDetector>, std::string> VotingDetector::make(const DetectorSettings& settings,
                                                                                const geometry::SensorCluster& cluster)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto enough = require_axes(cluster, 6, "voting"); !enough) return tl::unexpected(enough.error());
    if (settings.tolerance)
        return std::unique_ptr<VotingDetector>(new VotingDetector(settings, cluster, geometry::AxisVector::Ones(cluster.axes.rows())));
    const auto sigma = sigma_of_axes(settings, cluster);
    if (!sigma) return tl::unexpected(sigma.error() + "; or set tolerance");
    return std::unique_ptr<VotingDetector>(new VotingDetector(settings, cluster, *sigma));
}

VotingDetector::VotingDetector(const DetectorSettings& settings, const geometry::SensorCluster& cluster, geometry::AxisVector sigma)
    : FrameDetector(cluster),
      tolerance_(settings.tolerance.value_or(0)),
      pfa_(settings.pfa.value_or(default_false_alarm_probability)),
      max_faults_(settings.max_faults.value_or(2)),
      sigma_(std::move(sigma))
{
    form(cluster.all());  // the most triads and pairs there will ever be: later formings reuse this memory
}

void VotingDetector::form(AxisMask working)
{
    projector_ = geometry::ParitySpace(cluster().axes, working).projector();
    triads_.clear();
    for_each_subset(working, 3, [&](AxisMask rows) {
        const MaskMembers members(rows);
        const auto triad = geometry::triad_inverse(cluster().axes, {members.item[0], members.item[1], members.item[2]});
        if (triad) triads_.push_back(*triad);
    });
    estimate_.resize(triads_.size());
    reads_.clear();
    const std::size_t pairs = triads_.empty() ? 0 : triads_.size() * (triads_.size() - 1) / 2;
    reads_.reserve(pairs);
    for (std::size_t first = 0; first < triads_.size(); ++first)
        for (std::size_t second = first + 1; second < triads_.size(); ++second) reads_.push_back(read_by(triads_[first], triads_[second]));
    passed_.resize(pairs);
    set_radii();
}

void VotingDetector::set_radii()
{
    radius_.assign(triads_.size(), 0.5 * tolerance_);
    largest_radius_ = 0.5 * tolerance_;
    if (tolerance_ > 0 || triads_.empty()) return;
    const double quantile = std::sqrt(chi_square_quantile(3, pfa_ / static_cast<double>(triads_.size())));
    for (std::size_t t = 0; t < triads_.size(); ++t) {
        Eigen::Matrix3d root = triads_[t].body_from_axes;  // a root of the covariance of the estimate
        for (Eigen::Index k = 0; k < 3; ++k) root.col(k) *= sigma_(static_cast<Eigen::Index>(triads_[t].axis[static_cast<std::size_t>(k)]));
        const Eigen::Matrix3d covariance = root * root.transpose();
        radius_[t] =
            quantile * std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()(2));
        largest_radius_ = std::max(largest_radius_, radius_[t]);
    }
}

void VotingDetector::judge(const geometry::AxisVector& z, Assessment& assessment)
{
    for (std::size_t t = 0; t < triads_.size(); ++t) estimate_[t] = triads_[t].body(z);

    double worst = 0;
    passed_count_ = 0;
    std::size_t pair = 0;
    for (std::size_t first = 0; first < triads_.size(); ++first)
        for (std::size_t second = first + 1; second < triads_.size(); ++second, ++pair) {
            const double difference = (estimate_[first] - estimate_[second]).norm();
            const double tolerance = radius_[first] + radius_[second];
            passed_[pair] = difference <= tolerance ? 1 : 0;
            passed_count_ += passed_[pair];
            worst = std::max(worst, difference / tolerance);
        }
    assessment.statistic = worst * 2 * largest_radius_;
    assessment.threshold = 2 * largest_radius_;
    Eigen::Map<Eigen::VectorXd>(assessment.residual.data(), z.size()) = projector_ * z;

    const unsigned m = static_cast<unsigned>(std::popcount(working()));
    const auto faulty = exact_pattern(reads_, passed_, m < 4 ? 0 : std::min(max_faults_, m - 4));
    assessment.isolated = faulty.value_or(0);
    assessment.outcome = !faulty ? Outcome::refused : *faulty == 0 ? Outcome::healthy : Outcome::isolated;
}

std::vector<Detail> VotingDetector::details(const Assessment&) const
{
    return {{"passed_count", static_cast<std::int64_t>(passed_count())}};
}

}  // namespace quorient::fdi
