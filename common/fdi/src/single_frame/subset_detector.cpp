#include "single_frame/subset_detector.hpp"

#include "single_frame/combinations.hpp"
#include "quorient/fdi/noise.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace quorient::fdi {

namespace {

constexpr double singular = 1e-9;  // a pivot of P, whose entries are at most one

/// A largest independent choice among columns of P, in ascending order, and L^-1 of that choice: P_ww = L L'.
struct Factor {
    std::array<std::uint8_t, max_axes> axis{};
    std::size_t rank = 0;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, static_cast<int>(max_axes), static_cast<int>(max_axes)> inverse;

    Factor(const geometry::AxisMatrix& projector, AxisMask axes) : inverse(geometry::AxisMatrix::Zero(max_axes, max_axes))
    {
        const MaskMembers members(axes);
        for (std::size_t k = 0; k < members.count; ++k) take(projector, members.item[k]);
    }

    std::span<const std::uint8_t> independent() const { return {axis.data(), rank}; }

private:
    /// One more row of the Cholesky factor's inverse, if the axis is independent of those taken before.
    void take(const geometry::AxisMatrix& projector, std::uint8_t next)
    {
        const auto r = static_cast<Eigen::Index>(rank);
        geometry::AxisVector coupling(r);
        for (Eigen::Index k = 0; k < r; ++k) coupling(k) = projector(axis[static_cast<std::size_t>(k)], next);
        const geometry::AxisVector row = inverse.topLeftCorner(r, r) * coupling;
        const double pivot = projector(next, next) - row.squaredNorm();
        if (pivot < singular) return;
        const double scale = 1 / std::sqrt(pivot);
        inverse.row(r).head(r) = -scale * (row.transpose() * inverse.topLeftCorner(r, r));
        inverse(r, r) = scale;
        axis[rank++] = next;
    }
};

std::size_t units_of(const geometry::SensorCluster& cluster, bool instruments)
{
    if (!instruments) return cluster.size();
    return *std::max_element(cluster.instrument.begin(), cluster.instrument.end()) + 1;
}

std::size_t count_sets(std::size_t units, unsigned max_faults)
{
    std::size_t count = 0;
    for (unsigned size = 1; size <= max_faults; ++size) count += binomial(units, size);
    return count;
}

}  // namespace

tl::expected<std::unique_ptr<SubsetDetector>, std::string> SubsetDetector::make(const DetectorSettings& settings,
                                                                                    const geometry::SensorCluster& cluster)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto enough = require_axes(cluster, 4, "subset"); !enough) return tl::unexpected(enough.error());
    const std::size_t redundant = cluster.size() - 3;
    const std::size_t units = units_of(cluster, settings.instruments);
    DetectorSettings complete = settings;
    complete.max_faults = settings.max_faults.value_or(static_cast<unsigned>(std::min<std::size_t>({2, redundant, units})));
    if (*complete.max_faults > redundant || *complete.max_faults > units)
        return tl::unexpected(fmt::format("subset: max_faults {} is more than {} {} with {} redundant axes can show", *complete.max_faults,
                                          units, settings.instruments ? "instruments" : "axes", redundant));
    if (const std::size_t sets = count_sets(units, *complete.max_faults); sets > max_sets)
        return tl::unexpected(
            fmt::format("subset: max_faults {} means {} sets to try in every frame, at most {} are allowed: lower max_faults",
                        *complete.max_faults, sets, max_sets));
    const auto sigma = sigma_of_axes(settings, cluster);
    if (!sigma) return tl::unexpected(sigma.error());
    return std::unique_ptr<SubsetDetector>(new SubsetDetector(cluster, *sigma, complete));
}

SubsetDetector::SubsetDetector(const geometry::SensorCluster& cluster, geometry::AxisVector sigma, const DetectorSettings& settings)
    : FrameDetector(cluster),
      sigma_(std::move(sigma)),
      max_faults_(settings.max_faults.value_or(2)),
      margin_(settings.margin.value_or(default_margin)),
      instruments_(settings.instruments),
      unit_count_(units_of(cluster, settings.instruments)),
      parity_(cluster.axes, sigma_),
      residual_(geometry::AxisVector::Zero(sigma_.size()))
{
    for (unsigned dof = 0; dof < max_axes; ++dof) {
        limit_[dof] = chi_square_quantile(dof, settings.pfa.value_or(default_false_alarm_probability));
        doubt_limit_[dof] = settings.doubt ? chi_square_quantile(dof, *settings.doubt) : limit_[dof];
    }

    std::size_t members = 0;
    std::size_t weights = 0;
    const std::size_t redundant = cluster.size() - 3;
    for (unsigned size = 1; size <= max_faults_; ++size) {
        const std::size_t most = std::min(redundant, instruments_ ? cluster.size() : std::size_t{size});
        members += binomial(unit_count_, size) * most;
        weights += binomial(unit_count_, size) * most * (most + 1) / 2;
    }
    sets_.reserve(count_sets(unit_count_, max_faults_));
    left_.reserve(sets_.capacity());
    members_.reserve(members);
    weights_.reserve(weights);
    form(cluster.all());
}

AxisMask SubsetDetector::axes_of(AxisMask units, AxisMask working) const
{
    if (!instruments_) return units & working;
    AxisMask axes = 0;
    for (std::size_t axis = 0; axis < cluster().size(); ++axis)
        if (has_axis(units, cluster().instrument[axis])) axes |= axis_bit(axis);
    return axes & working;
}

void SubsetDetector::form(AxisMask working)
{
    parity_ = WeightedParity(cluster().axes, sigma_, working);
    sets_.clear();
    members_.clear();
    weights_.clear();
    for (unsigned size = 1; size <= max_faults_; ++size)
        for_each_subset(all_axes(unit_count_), size, [&](AxisMask units) {
            const AxisMask axes = axes_of(units, working);
            const Factor factor(parity_.space().projector(), axes);
            if (adds_nothing(units, working, factor.rank)) return;
            add_set(axes, size, factor.independent());
            for (Eigen::Index row = 0; row < static_cast<Eigen::Index>(factor.rank); ++row)
                for (Eigen::Index column = 0; column <= row; ++column) weights_.push_back(factor.inverse(row, column));
        });
    left_.resize(sets_.size());
}

/// Whether some set with one unit less explains as much.
bool SubsetDetector::adds_nothing(AxisMask units, AxisMask working, std::size_t rank) const
{
    if (!instruments_) return rank < static_cast<std::size_t>(std::popcount(units));
    const MaskMembers members(units);
    for (std::size_t k = 0; k < members.count; ++k)
        if (Factor(parity_.space().projector(), axes_of(units & ~axis_bit(members.item[k]), working)).rank == rank) return true;
    return false;
}

void SubsetDetector::add_set(AxisMask axes, std::size_t size, std::span<const std::uint8_t> independent)
{
    sets_.push_back({axes, static_cast<std::uint8_t>(size), static_cast<std::uint8_t>(independent.size()),
                     static_cast<std::uint32_t>(members_.size()), static_cast<std::uint32_t>(weights_.size()),
                     !instruments_ && size < max_faults_ ? visibility_beside(axes) : 0});
    members_.insert(members_.end(), independent.begin(), independent.end());
}

/// min over j outside w of P_jj - P_jw (P_ww)^-1 P_wj.
double SubsetDetector::visibility_beside(AxisMask axes) const
{
    const auto& projector = parity_.space().projector();
    const Factor factor(projector, axes);
    const auto rank = static_cast<Eigen::Index>(factor.rank);
    double least = 1;
    for (Eigen::Index other = 0; other < projector.rows(); ++other) {
        if (has_axis(axes, static_cast<std::size_t>(other)) || !parity_.space().sees(other)) continue;
        geometry::AxisVector coupling(rank);
        for (Eigen::Index k = 0; k < rank; ++k) coupling(k) = projector(factor.axis[static_cast<std::size_t>(k)], other);
        const geometry::AxisVector shared = factor.inverse.topLeftCorner(rank, rank) * coupling;
        least = std::min(least, projector(other, other) - shared.squaredNorm());
    }
    return std::max(0.0, least);
}

/// S_w: the squared norm of L^-1 r_w is what the set explains.
double SubsetDetector::left_by(const Set& set) const
{
    const std::uint8_t* member = members_.data() + set.member;
    const double* weight = weights_.data() + set.weight;
    double explained = 0;
    for (std::size_t row = 0; row < set.rank; ++row) {
        double projection = 0;
        for (std::size_t column = 0; column <= row; ++column) projection += *weight++ * residual_(member[column]);
        explained += projection * projection;
    }
    return std::max(0.0, sum_of_squares_ - explained);
}

/// min |f_w|, f_w = (P_ww)^-1 r_w, over sigma.
double SubsetDetector::smallest_fault(const Set& set) const
{
    std::array<double, max_axes> fault{};
    const double* weight = weights_.data() + set.weight;
    for (std::size_t row = 0; row < set.rank; weight += ++row) {
        double projection = 0;
        for (std::size_t column = 0; column <= row; ++column) projection += weight[column] * residual_(members_[set.member + column]);
        for (std::size_t column = 0; column <= row; ++column) fault[column] += weight[column] * projection;
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < set.rank; ++k) least = std::min(least, std::abs(fault[k]));
    return least;
}

void SubsetDetector::remember(const Score& score)
{
    if (best_count_ == best_.size() && score.statistic >= best_.back().statistic) return;
    std::size_t place = best_count_ < best_.size() ? best_count_++ : best_.size() - 1;
    for (; place > 0 && best_[place - 1].statistic > score.statistic; --place) best_[place] = best_[place - 1];
    best_[place] = score;
}

void SubsetDetector::judge(const geometry::AxisVector& z, Assessment& assessment)
{
    const geometry::AxisVector parity = parity_.parity(z) / parity_.sigma();
    residual_ = parity_.residual(parity);
    sum_of_squares_ = parity.squaredNorm();
    const unsigned q = parity_.redundancy();
    assessment.statistic = sum_of_squares_;
    assessment.threshold = limit_[q];
    for (Eigen::Index axis = 0; axis < z.size(); ++axis) {
        const double unit = parity_.sigma() / parity_.weight()(axis);
        assessment.residual[static_cast<std::size_t>(axis)] = residual_(axis) * unit;
        assessment.bound[static_cast<std::size_t>(axis)] = std::sqrt(limit_[q] * parity_.space().projector()(axis, axis)) * unit;
    }
    best_count_ = 0;
    assessment.outcome = sum_of_squares_ <= limit_[q] ? Outcome::healthy : Outcome::blind;
    if (assessment.outcome == Outcome::healthy) return;

    std::size_t tried = 0;
    for (unsigned size = 1; size <= max_faults_; ++size) {
        const Set* chosen = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (; tried < sets_.size() && sets_[tried].size == size; ++tried) {
            const Set& set = sets_[tried];
            left_[tried] = left_by(set);
            remember({set.axes, left_[tried]});
            if (left_[tried] < least && left_[tried] <= limit_[q - set.rank] + rounding()) {
                chosen = &set;
                least = left_[tried];
            }
        }
        if (chosen != nullptr) return name(*chosen, least, tried, assessment);
    }
}

/// Rounding error of S0 minus what is explained.
double SubsetDetector::rounding() const
{
    return 64 * std::numeric_limits<double>::epsilon() * sum_of_squares_;
}

void SubsetDetector::name(const Set& chosen, double statistic, std::size_t tried, Assessment& assessment) const
{
    const double rival = statistic + margin_ + rounding();
    const auto rivals =
        std::count_if(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(tried), [&](double left) { return left <= rival; });
    if (rivals > 1) {
        assessment.outcome = Outcome::ambiguous;
        for (std::size_t k = 0; k < best_count_ && best_[k].statistic <= rival; ++k) assessment.add_candidate(best_[k].axes);
        assessment.candidates_truncated = static_cast<std::size_t>(rivals) > assessment.candidate_count;
        return;
    }
    const bool perhaps_none = sum_of_squares_ <= rival;
    const bool perhaps_more = chosen.size < max_faults_ && statistic > doubt_limit_[parity_.redundancy() - chosen.rank] + rounding();
    const bool immaterial =
        perhaps_more && material * smallest_fault(chosen) * std::sqrt(chosen.visibility) >= std::sqrt(statistic) + std::sqrt(margin_);
    assessment.outcome = perhaps_none || (perhaps_more && !immaterial) ? Outcome::suspect : Outcome::isolated;
    assessment.isolated = chosen.axes;
}

std::vector<Detail> SubsetDetector::details(const Assessment&) const
{
    constexpr std::size_t shown = 5;
    std::vector<ScoredSet> scores;
    for (const Score& score : best().first(std::min(shown, best().size()))) scores.push_back({score.axes, score.statistic});
    return {{"scores", scores}};
}

}  // namespace quorient::fdi
