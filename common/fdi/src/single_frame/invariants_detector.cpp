#include "single_frame/invariants_detector.hpp"

#include "single_frame/combinations.hpp"
#include "single_frame/exact_pattern.hpp"
#include "quorient/fdi/noise.hpp"
#include "quorient/geometry/parity_space.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace quorient::fdi {

namespace {

/// v with v'H = 0 on four rows: each weight is the volume that the other three span, signs alternating. Norm 0 below rank 3.
Eigen::Vector4d annihilator(const geometry::Axes& axes, const std::array<std::uint8_t, 4>& axis)
{
    const auto volume = [&](std::size_t a, std::size_t b, std::size_t c) {
        const Eigen::Vector3d first = axes.row(axis[a]);
        const Eigen::Vector3d second = axes.row(axis[b]);
        const Eigen::Vector3d third = axes.row(axis[c]);
        return first.dot(second.cross(third));
    };
    return {volume(1, 2, 3), -volume(0, 2, 3), volume(0, 1, 3), -volume(0, 1, 2)};
}

}  // namespace

tl::expected<std::unique_ptr<InvariantsDetector>, std::string> InvariantsDetector::make(const DetectorSettings& settings,
                                                                        const geometry::SensorCluster& cluster)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto enough = require_axes(cluster, 6, "invariants"); !enough) return tl::unexpected(enough.error());
    if (settings.tolerance)
        return std::unique_ptr<InvariantsDetector>(new InvariantsDetector(settings, cluster, geometry::AxisVector::Ones(cluster.axes.rows())));
    const auto sigma = sigma_of_axes(settings, cluster);
    if (!sigma) return tl::unexpected(sigma.error() + "; or set tolerance");
    return std::unique_ptr<InvariantsDetector>(new InvariantsDetector(settings, cluster, *sigma));
}

InvariantsDetector::InvariantsDetector(const DetectorSettings& settings, const geometry::SensorCluster& cluster, geometry::AxisVector sigma)
    : FrameDetector(cluster),
      tolerance_(settings.tolerance.value_or(0)),
      pfa_(settings.pfa.value_or(default_false_alarm_probability)),
      max_faults_(settings.max_faults.value_or(2)),
      relaxed_(settings.relaxed),
      bare_(settings.bare),
      sigma_(std::move(sigma))
{
    const std::size_t most = binomial(cluster.size(), 4);
    quadruples_.reserve(most);
    reads_.reserve(most);
    values_.reserve(most);
    passed_.reserve(most);
    form(cluster.all());
}

void InvariantsDetector::form(AxisMask working)
{
    constexpr double negligible = 1e-9;  // a smaller weight among weights of norm one counts as 0
    projector_ = geometry::ParitySpace(cluster().axes, working).projector();
    quadruples_.clear();
    reads_.clear();
    for_each_subset(working, 4, [&](AxisMask rows) {
        Quadruple quadruple;
        const MaskMembers members(rows);
        std::copy_n(members.item.begin(), 4, quadruple.axis.begin());
        quadruple.weight = annihilator(cluster().axes, quadruple.axis);
        const double norm = quadruple.weight.norm();
        if (norm < geometry::coplanar_tolerance) return;
        quadruple.weight /= norm;
        AxisMask reads = 0;
        for (Eigen::Index k = 0; k < 4; ++k)
            if (std::abs(quadruple.weight(k)) > negligible) reads |= axis_bit(quadruple.axis[static_cast<std::size_t>(k)]);
        quadruples_.push_back(quadruple);
        reads_.push_back(reads);
    });
    values_.resize(quadruples_.size());
    passed_.resize(quadruples_.size());
    set_tolerances();
}

void InvariantsDetector::set_tolerances()
{
    const double quantile = quadruples_.empty() ? 0 : normal_quantile(pfa_ / (2.0 * static_cast<double>(quadruples_.size())));
    largest_tolerance_ = 0;
    for (Quadruple& quadruple : quadruples_) {
        double variance = 0;
        for (Eigen::Index k = 0; k < 4; ++k)
            variance += std::pow(quadruple.weight(k) * sigma_(quadruple.axis[static_cast<std::size_t>(k)]), 2);
        quadruple.tolerance = tolerance_ > 0 ? tolerance_ : quantile * std::sqrt(variance);
        largest_tolerance_ = std::max(largest_tolerance_, quadruple.tolerance);
    }
}

/// One quadruple, at least, has to stay outside the faults.
unsigned InvariantsDetector::allowed_faults() const
{
    const unsigned m = static_cast<unsigned>(std::popcount(working()));
    return m < 4 ? 0 : std::min(max_faults_, m - 4);
}

void InvariantsDetector::judge(const geometry::AxisVector& z, Assessment& assessment)
{
    double worst = 0;
    for (std::size_t k = 0; k < quadruples_.size(); ++k) {
        const Quadruple& quadruple = quadruples_[k];
        const double value = std::abs(quadruple.weight(0) * z(quadruple.axis[0]) + quadruple.weight(1) * z(quadruple.axis[1]) +
                                      quadruple.weight(2) * z(quadruple.axis[2]) + quadruple.weight(3) * z(quadruple.axis[3]));
        values_[k] = value;
        passed_[k] = value <= quadruple.tolerance ? 1 : 0;
        worst = std::max(worst, value / quadruple.tolerance);
    }
    assessment.statistic = worst * largest_tolerance_;
    assessment.threshold = largest_tolerance_;
    Eigen::Map<Eigen::VectorXd>(assessment.residual.data(), z.size()) = projector_ * z;

    const auto faulty = exact_pattern(reads_, passed_, allowed_faults());
    assessment.isolated = faulty.value_or(0);
    assessment.outcome = !faulty ? Outcome::refused : *faulty == 0 ? Outcome::healthy : Outcome::isolated;
    if (!faulty && relaxed_) relax(assessment);
}

/// The largest ratio |v'z| / T of the quadruples that read none of these axes; infinite where there is no such quadruple.
double InvariantsDetector::worst_ratio_without(AxisMask without) const
{
    double worst = 0;
    bool any = false;
    for (std::size_t k = 0; k < quadruples_.size(); ++k) {
        if ((reads_[k] & without) != 0) continue;
        worst = std::max(worst, values_[k] / quadruples_[k].tolerance);
        any = true;
    }
    return any ? worst : std::numeric_limits<double>::infinity();
}

/// The paper's relaxed rule. @returns the axes to leave out, or none where even the best choice fails.
AxisMask InvariantsDetector::best_exclusion() const
{
    AxisMask best = 0;
    double best_ratio = 1;
    if (allowed_faults() == 0) return 0;
    for_each_subset(working(), allowed_faults(), [&](AxisMask without) {
        const double worst = worst_ratio_without(without);
        if (worst > best_ratio) return;
        best = without;
        best_ratio = worst;
    });
    return best;
}

void InvariantsDetector::relax(Assessment& assessment) const
{
    if (bare_) assessment.isolated = best_exclusion();
    else
        for (unsigned size = 1; size <= allowed_faults() && assessment.candidate_count == 0; ++size)
            for_each_subset(working(), size, [&](AxisMask set) {
                if (worst_ratio_without(set) <= 1) assessment.add_candidate(set);
            });
    if (assessment.candidate_count == 1) assessment.isolated = assessment.candidate[0];
    if (assessment.isolated != 0) assessment.outcome = Outcome::isolated;
    else if (assessment.candidate_count > 1) assessment.outcome = Outcome::ambiguous;
    if (assessment.candidate_count == 1) assessment.candidate_count = 0;
}

std::vector<Detail> InvariantsDetector::details(const Assessment&) const
{
    const std::vector<bool> passes(passed_.begin(), passed_.end());
    return {{"values", values_},
            {"passed_count", std::int64_t{std::count(passes.begin(), passes.end(), true)}},
            {"passed", passes}};
}

}  // namespace quorient::fdi
