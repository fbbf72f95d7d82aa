#include "single_frame/guaranteed_detector.hpp"

#include "single_frame/combinations.hpp"
#include "quorient/fdi/noise.hpp"
#include "quorient/geometry/parity_space.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <fmt/format.h>
#include <Eigen/QR>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace quorient::fdi {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double negligible_weight = 1e-9;  // a smaller weight among weights of norm one counts as 0

Eigen::Index at(std::size_t axis)
{
    return static_cast<Eigen::Index>(axis);
}

/// x with H_T' x = direction for the independent rows T; nothing where they do not reach it.
std::optional<Eigen::Vector3d> reach(const geometry::Axes& axes, AxisMask rows, const Eigen::Vector3d& direction)
{
    using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;
    const MaskMembers members(rows);
    Rows transposed(3, at(members.count));
    for (std::size_t k = 0; k < members.count; ++k) transposed.col(at(k)) = axes.row(members.item[k]).transpose();

    const Eigen::HouseholderQR<Rows> factors(transposed);
    Eigen::Vector3d solution = Eigen::Vector3d::Zero();
    solution.head(at(members.count)) = factors.solve(direction);
    const Eigen::Vector3d reached = transposed * solution.head(at(members.count));
    if ((reached - direction).norm() > geometry::coplanar_tolerance * std::max(1.0, solution.cwiseAbs().maxCoeff())) return {};
    return solution;
}

}  // namespace

tl::expected<std::unique_ptr<GuaranteedDetector>, std::string> GuaranteedDetector::make(const DetectorSettings& settings,
                                                                        const geometry::SensorCluster& cluster)
{
    const std::size_t n = cluster.size();
    const unsigned max_faults = settings.max_faults.value_or(n >= 6 ? 2 : 1);
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (max_faults > 2) return tl::unexpected(fmt::format("guaranteed works with max_faults 1 or 2, got {}", max_faults));
    if (n < max_faults + 4 || n > max_size)
        return tl::unexpected(
            fmt::format("guaranteed with max_faults {} works with {} to {} axes (one redundant axis must be left), this cluster has {}",
                        max_faults, max_faults + 4, max_size, n));
    const auto bound = bound_of_axes(settings, cluster);
    if (!bound) return tl::unexpected(bound.error());

    std::unique_ptr<GuaranteedDetector> detector(new GuaranteedDetector(cluster, *bound, max_faults));
    detector->form(cluster.all());
    if (settings.threshold) detector->threshold_ = *settings.threshold;
    else if (!std::isfinite(detector->threshold_))
        return tl::unexpected(
            fmt::format("guaranteed with max_faults {} is never decided on this cluster (some {} axes span no space): lower max_faults, or "
                        "set threshold",
                        max_faults, n - max_faults));
    detector->configured_threshold_ = settings.threshold;
    if (settings.direction) detector->direction_ = Eigen::Map<const Eigen::Vector3d>(settings.direction->data());
    return detector;
}

GuaranteedDetector::GuaranteedDetector(const geometry::SensorCluster& cluster, const geometry::AxisVector& bound, unsigned max_faults)
    : FrameDetector(cluster),
      bound_(bound),
      max_faults_(max_faults),
      largest_bound_(bound.maxCoeff()),
      z_(geometry::AxisVector::Zero(bound.size()))
{
}

void GuaranteedDetector::form(AxisMask working)
{
    form_sets(working);
    form_bases(working);
    form_circuits(working);
    threshold_ = configured_threshold_.value_or(least_decisive_threshold());
}

void GuaranteedDetector::form_sets(AxisMask working)
{
    const std::size_t m = static_cast<std::size_t>(std::popcount(working));
    const std::size_t faults = m < 4 ? 0 : std::min<std::size_t>(max_faults_, m - 4);
    set_count_ = 0;
    for_each_subset(working, faults, [&](AxisMask without) {
        FaultSet& set = sets_[set_count_++];
        set.without = without;
        set.rank = static_cast<std::uint8_t>(geometry::rank_of(cluster().axes, working & ~without));
        set.basis_count = 0;
    });
}

void GuaranteedDetector::form_bases(AxisMask working)
{
    basis_count_ = 0;
    for (std::size_t rank = 3; rank >= 1; --rank)
        if (std::any_of(sets_.begin(), sets_.begin() + static_cast<std::ptrdiff_t>(set_count_),
                        [&](const FaultSet& set) { return set.rank == rank; }))
            for_each_subset(working, rank, [&](AxisMask rows) {
                if (geometry::rank_of(cluster().axes, rows) == static_cast<int>(rank)) add_basis(rows);
            });
}

void GuaranteedDetector::add_basis(AxisMask rows)
{
    const std::size_t index = basis_count_++;
    Basis& basis = bases_[index];
    const MaskMembers members(rows);
    basis.rows = rows;
    basis.rank = static_cast<std::uint8_t>(members.count);
    basis.row = {};
    basis.spread.setZero();
    for (std::size_t k = 0; k < 3; ++k) {
        basis.row[k] = k < members.count ? members.item[k] : members.item[0];
        basis.solution[k].setZero();
    }
    for (std::size_t axis = 0; axis < cluster().size(); ++axis) {
        const auto solution = reach(cluster().axes, rows, cluster().axes.row(at(axis)).transpose());
        if (!solution) basis.spread(at(axis)) = infinity;
        else
            for (std::size_t k = 0; k < members.count; ++k) {
                basis.solution[k](at(axis)) = (*solution)(at(k));
                basis.spread(at(axis)) += bound_(members.item[k]) * std::abs((*solution)(at(k)));
            }
    }
    for (std::size_t w = 0; w < set_count_; ++w)
        if (sets_[w].rank == basis.rank && (sets_[w].without & rows) == 0)
            sets_[w].basis[sets_[w].basis_count++] = static_cast<std::uint8_t>(index);
}

void GuaranteedDetector::form_circuits(AxisMask working)
{
    circuit_count_ = 0;
    for (std::size_t size = 4; size >= 2; --size) for_each_subset(working, size, [&](AxisMask rows) { add_circuit(rows); });
}

void GuaranteedDetector::add_circuit(AxisMask rows)
{
    const geometry::ParitySpace space(cluster().axes, rows);
    if (space.redundancy() != 1) return;

    Circuit& circuit = circuits_[circuit_count_];
    const MaskMembers members(rows);
    AxisMask support = 0;
    double limit = 0;
    circuit.row = {};
    circuit.weight.setZero();
    for (std::size_t k = 0; k < members.count; ++k) {
        const double weight = space.basis()(0, members.item[k]);
        circuit.row[k] = members.item[k];
        if (std::abs(weight) < negligible_weight) continue;
        circuit.weight(at(k)) = weight;
        limit += bound_(members.item[k]) * std::abs(weight);
        support |= axis_bit(members.item[k]);
    }
    circuit.weight /= limit;
    circuit.outside.reset();
    for (std::size_t w = 0; w < set_count_; ++w) circuit.outside.set(w, (sets_[w].without & support) == 0);
    if (circuit.outside.any()) ++circuit_count_;
}

/// With regular errors only, lmax_i - z_i <= I_w - z_i <= 2 min over bases of spread_i + sigma_i for the worst w, and some corner of
/// the error box attains it: 7 sigma on the cone, 1 + 2 sqrt 5 on the dodecahedron.
double GuaranteedDetector::least_decisive_threshold() const
{
    PerAxis worst = PerAxis::Zero();
    for (std::size_t w = 0; w < set_count_; ++w) {
        PerAxis least = PerAxis::Constant(infinity);
        for (std::size_t b = 0; b < sets_[w].basis_count; ++b) least = least.min(bases_[sets_[w].basis[b]].spread);
        worst = worst.max(least);
    }
    const Eigen::Index n = bound_.size();
    constexpr double rounding = 1e-9;
    return (1 + rounding) * (2 * worst.head(n) + bound_.array()).maxCoeff();
}

void GuaranteedDetector::judge(const geometry::AxisVector& z, Assessment& assessment)
{
    z_ = z;
    assessment.statistic = test_feasibility(z);
    assessment.threshold = largest_bound_;
    if (feasible_.none()) {
        decision_.fill('U');
        assessment.outcome = Outcome::blind;
        return;
    }
    bound_axes(z);
    decide(z, assessment);
}

/// @returns the least bound (of the axis with the largest) with which no fault at all would explain z.
double GuaranteedDetector::test_feasibility(const geometry::AxisVector& z)
{
    // Noise at its very bound must not become a fault by rounding: |v'z| is exact to a few ulps of max |z| sum |v|.
    const double rounding = 16 * std::numeric_limits<double>::epsilon() * z.cwiseAbs().maxCoeff() / bound_.minCoeff();
    double largest = 0;
    SetFlags infeasible;
    for (std::size_t c = 0; c < circuit_count_; ++c) {
        const Circuit& circuit = circuits_[c];
        const double value = std::abs(circuit.weight(0) * z(circuit.row[0]) + circuit.weight(1) * z(circuit.row[1]) +
                                      circuit.weight(2) * z(circuit.row[2]) + circuit.weight(3) * z(circuit.row[3]));
        largest = std::max(largest, value);
        if (value > 1 + rounding) infeasible |= circuit.outside;
    }
    feasible_.reset();
    for (std::size_t w = 0; w < set_count_; ++w) feasible_.set(w, !infeasible.test(w));
    return largest * largest_bound_;
}

/// I_w = min over bases of x'z + spread, J_w = max of x'z - spread; then the hull over the feasible w.
void GuaranteedDetector::bound_axes(const geometry::AxisVector& z)
{
    std::array<PerAxis, max_bases> below;
    std::array<PerAxis, max_bases> above;
    for (std::size_t b = 0; b < basis_count_; ++b) {
        const Basis& basis = bases_[b];
        const PerAxis centre =
            basis.solution[0] * z(basis.row[0]) + basis.solution[1] * z(basis.row[1]) + basis.solution[2] * z(basis.row[2]);
        below[b] = centre - basis.spread;
        above[b] = centre + basis.spread;
    }
    lower_.setConstant(infinity);
    upper_.setConstant(-infinity);
    for (std::size_t w = 0; w < set_count_; ++w) {
        if (!feasible_.test(w)) continue;
        PerAxis least = PerAxis::Constant(-infinity);
        PerAxis most = PerAxis::Constant(infinity);
        for (std::size_t k = 0; k < sets_[w].basis_count; ++k) {
            least = least.max(below[sets_[w].basis[k]]);
            most = most.min(above[sets_[w].basis[k]]);
        }
        lower_ = lower_.min(least);
        upper_ = upper_.max(most);
    }
}

void GuaranteedDetector::decide(const geometry::AxisVector& z, Assessment& assessment)
{
    AxisMask faulty = 0;
    AxisMask undecided = 0;
    for (std::size_t axis = 0; axis < cluster().size(); ++axis) {
        if (!has_axis(working(), axis)) continue;
        const Interval hull = interval(axis);
        const double above = z(at(axis)) - hull.lower;  // rho + delta
        const double below = z(at(axis)) - hull.upper;  // rho - delta
        const bool beyond = below > threshold_ || above < -threshold_;
        const bool within = above <= threshold_ && below >= -threshold_;
        decision_[axis] = beyond ? 'F' : within ? 'H' : 'U';
        if (beyond) faulty |= axis_bit(axis);
        else if (!within) undecided |= axis_bit(axis);
        assessment.bound[axis] = 0.5 * (above - below);
        if (std::isfinite(assessment.bound[axis])) assessment.residual[axis] = 0.5 * (above + below);
    }
    if (undecided == 0) {
        assessment.outcome = faulty == 0 ? Outcome::healthy : Outcome::isolated;
        assessment.isolated = faulty;
    } else if (feasible_.count() == 1) {
        assessment.outcome = Outcome::suspect;
        assessment.isolated = faulty;
    } else {
        assessment.outcome = Outcome::ambiguous;
        for (std::size_t w = 0; w < set_count_; ++w)
            if (feasible_.test(w)) assessment.add_candidate(sets_[w].without);
    }
}

GuaranteedDetector::Interval GuaranteedDetector::interval(std::size_t axis) const
{
    return {lower_(at(axis)), upper_(at(axis))};
}

GuaranteedDetector::Interval GuaranteedDetector::interval_of(std::size_t index, const Eigen::Vector3d& direction) const
{
    if (!feasible_.test(index)) return {infinity, -infinity};
    Interval interval{-infinity, infinity};
    for (std::size_t k = 0; k < sets_[index].basis_count; ++k) {
        const Basis& basis = bases_[sets_[index].basis[k]];
        const auto solution = reach(cluster().axes, basis.rows, direction);
        if (!solution) continue;
        double centre = 0;
        double spread = 0;
        for (std::size_t row = 0; row < basis.rank; ++row) {
            centre += (*solution)(at(row)) * z_(basis.row[row]);
            spread += std::abs((*solution)(at(row))) * bound_(basis.row[row]);
        }
        interval.lower = std::max(interval.lower, centre - spread);
        interval.upper = std::min(interval.upper, centre + spread);
    }
    return interval;
}

GuaranteedDetector::Interval GuaranteedDetector::interval_along(const Eigen::Vector3d& direction) const
{
    Interval hull{infinity, -infinity};
    for (std::size_t w = 0; w < set_count_; ++w) {
        const Interval interval = interval_of(w, direction);
        hull.lower = std::min(hull.lower, interval.lower);
        hull.upper = std::max(hull.upper, interval.upper);
    }
    return hull;
}

/// Where every set is empty nothing is estimated: NaN in the shape of the figures.
void GuaranteedDetector::add_axes(const Assessment& assessment, std::vector<Detail>& details) const
{
    const auto axes = static_cast<std::size_t>(cluster().axes.rows());
    std::vector<Detail::Interval> intervals;
    std::vector<double> estimate;
    std::vector<double> half_width;
    std::vector<std::string> decisions;
    for (std::size_t axis = 0; axis < axes; ++axis) {
        const Interval hull = empty() ? Interval{NAN, NAN} : interval(axis);
        intervals.push_back({hull.lower, hull.upper});
        estimate.push_back(0.5 * (hull.lower + hull.upper));
        half_width.push_back(empty() ? NAN : assessment.bound[axis]);
        decisions.push_back(empty() ? std::string() : std::string(1, decision(axis)));
    }
    if (empty()) details.push_back({"residual", std::vector<double>(axes, NAN)});
    details.push_back({"interval", std::move(intervals)});
    details.push_back({"estimate", std::move(estimate)});
    details.push_back({"half_width", std::move(half_width)});
    details.push_back({"decision", std::move(decisions)});
}

std::vector<Detail> GuaranteedDetector::details(const Assessment& assessment) const
{
    std::vector<Detail::Axes> sets;
    for (std::size_t w = 0; w < set_count(); ++w)
        if (feasible(w)) sets.push_back({set(w)});
    std::vector<Detail> details;
    if (assessment.outcome == Outcome::ambiguous) details.push_back({"candidates", sets});
    details.push_back({"feasible_sets", sets});
    details.push_back({"empty", empty()});
    add_axes(assessment, details);
    if (direction_) {
        const Interval along = interval_along(*direction_);
        details.push_back({"direction_interval", Detail::Interval{along.lower, along.upper}});
    }
    return details;
}

}  // namespace quorient::fdi
