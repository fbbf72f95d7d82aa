#include "judges.hpp"

#include "single_frame/exact_pattern.hpp"
#include "quorient/fdi/methods.hpp"
#include "quorient/geometry/parity_space.hpp"
#include "quorient/geometry/triads.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace quorient::studies {

namespace {

constexpr double negligible = 1e-9;  // for a coefficient beside others of order one

class MethodJudge final : public Judge {
public:
    MethodJudge(const fdi::DetectorSettings& settings, const geometry::SensorCluster& cluster) : valid_(cluster.all())
    {
        auto made = fdi::make_detector(settings, cluster);
        if (!made) throw std::logic_error(made.error());
        detector_ = std::move(*made);
    }

    Answer answer(std::span<const double> measurement) override
    {
        detector_->assess({.identity = {1, sequence_++}, .interval_s = 1, .increment = measurement, .valid = valid_}, assessment_);
        if (assessment_.outcome == fdi::Outcome::healthy) return {true, 0};
        return {assessment_.outcome == fdi::Outcome::isolated, assessment_.isolated};
    }

private:
    std::unique_ptr<fdi::Detector> detector_;
    AxisMask valid_;
    std::uint64_t sequence_ = 0;
    fdi::Assessment assessment_;
};

class KnownCount final : public Judge {
public:
    KnownCount(const geometry::SensorCluster& cluster, const Faults& faults, bool posterior)
        : space_(cluster.axes), faults_(faults), posterior_(posterior)
    {
        for (AxisMask axes = 1; axes <= cluster.all(); ++axes)
            if (static_cast<std::size_t>(std::popcount(axes)) == faults.count) add(axes);
    }

    Answer answer(std::span<const double> measurement) override
    {
        const auto z = Eigen::Map<const Eigen::VectorXd>(measurement.data(), space_.size());
        residual_.noalias() = space_.projector() * z;
        const Set* best = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (const Set& set : sets_) {
            const Eigen::Vector2d own(residual_(set.first), set.pair ? residual_(set.second) : 0);
            const Eigen::Vector2d estimate = set.inverse * own;
            double score = -own.dot(estimate);  // S_w - S0
            if (posterior_) score += set.log_determinant - 2 * log_share_in_range(set, estimate);
            if (score >= least) continue;
            least = score;
            best = &set;
        }
        return {best != nullptr, best != nullptr ? best->axes : 0};
    }

private:
    struct Set {
        AxisMask axes = 0;
        Eigen::Index first = 0;
        Eigen::Index second = 0;
        bool pair = false;
        Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();  // inverse of P_ww
        double log_determinant = 0;
    };

    void add(AxisMask axes)
    {
        Set set;
        set.axes = axes;
        set.pair = faults_.count == 2;
        set.first = std::countr_zero(axes);
        set.second = set.pair ? std::countr_zero(axes & (axes - 1)) : set.first;
        const auto& p = space_.projector();
        Eigen::Matrix2d own = Eigen::Matrix2d::Identity();
        own(0, 0) = p(set.first, set.first);
        if (set.pair) own << p(set.first, set.first), p(set.first, set.second), p(set.second, set.first), p(set.second, set.second);
        if (own.determinant() < negligible) return;
        set.inverse = own.inverse();
        set.log_determinant = std::log(own.determinant());
        sets_.push_back(set);
    }

    /// log of how much of N(estimate, (P_ww)^-1) lies in the range of sizes, the two faults taken as independent.
    double log_share_in_range(const Set& set, const Eigen::Vector2d& estimate) const
    {
        double share = 1;
        for (Eigen::Index k = 0; k < (set.pair ? 2 : 1); ++k) {
            const double scale = std::sqrt(0.5 / set.inverse(k, k));
            const double size = std::abs(estimate(k));
            share *= std::erf((faults_.most - size) * scale) - std::erf((faults_.least - size) * scale);
        }
        return std::log(std::max(share, std::numeric_limits<double>::min()));
    }

    geometry::ParitySpace space_;
    Faults faults_;
    bool posterior_;
    std::vector<Set> sets_;
    geometry::AxisVector residual_;
};

/// Comparisons c'z against a tolerance each, decided by the exact pattern. One comparison may have several rows c.
class PatternJudge final : public Judge {
public:
    struct Row {
        std::size_t comparison = 0;
        Eigen::VectorXd weight;
        double tolerance = 0;
    };

    PatternJudge(std::vector<Row> rows, std::vector<AxisMask> reads)
        : rows_(std::move(rows)), reads_(std::move(reads)), passed_(reads_.size())
    {
    }

    Answer answer(std::span<const double> measurement) override
    {
        passed_.assign(passed_.size(), 1);
        const auto z = Eigen::Map<const Eigen::VectorXd>(measurement.data(), static_cast<Eigen::Index>(measurement.size()));
        for (const Row& row : rows_)
            if (passed_[row.comparison] != 0 && std::abs(row.weight.dot(z)) > row.tolerance) passed_[row.comparison] = 0;
        const auto faulty = fdi::exact_pattern(reads_, passed_, 2);
        return {faulty.has_value(), faulty.value_or(0)};
    }

private:
    std::vector<Row> rows_;
    std::vector<AxisMask> reads_;
    std::vector<std::uint8_t> passed_;
};

AxisMask reads_of(const Eigen::VectorXd& weight)
{
    AxisMask reads = 0;
    for (Eigen::Index axis = 0; axis < weight.size(); ++axis)
        if (std::abs(weight(axis)) > negligible) reads |= axis_bit(static_cast<std::size_t>(axis));
    return reads;
}

std::unique_ptr<Judge> quadruples(const geometry::SensorCluster& cluster, double factor)
{
    std::vector<PatternJudge::Row> rows;
    std::vector<AxisMask> reads;
    for (AxisMask axes = 1; axes <= cluster.all(); ++axes) {
        if (std::popcount(axes) != 4) continue;
        const geometry::ParitySpace space(cluster.axes, axes);
        if (space.redundancy() != 1) continue;  // coplanar
        const Eigen::VectorXd weight = space.basis().row(0).transpose();
        rows.push_back({reads.size(), weight, factor * weight.cwiseAbs().sum()});
        reads.push_back(reads_of(weight));
    }
    return std::make_unique<PatternJudge>(std::move(rows), std::move(reads));
}

/// M of x_T = M z: the triad's inverse in the columns of its axes.
geometry::BodyFromAxes estimate_of(const geometry::Triad& triad, Eigen::Index axes)
{
    geometry::BodyFromAxes estimate = geometry::BodyFromAxes::Zero(3, axes);
    for (std::size_t k = 0; k < 3; ++k)
        estimate.col(static_cast<Eigen::Index>(triad.axis[k])) = triad.body_from_axes.col(static_cast<Eigen::Index>(k));
    return estimate;
}

std::unique_ptr<Judge> triad_components(const geometry::SensorCluster& cluster, double sigmas)
{
    const auto triads = geometry::triads(cluster.axes);
    std::vector<PatternJudge::Row> rows;
    std::vector<AxisMask> reads;
    for (std::size_t first = 0; first < triads.size(); ++first)
        for (std::size_t second = first + 1; second < triads.size(); ++second) {
            const geometry::BodyFromAxes difference =
                estimate_of(triads[first], cluster.axes.rows()) - estimate_of(triads[second], cluster.axes.rows());
            AxisMask read = 0;
            for (Eigen::Index component = 0; component < 3; ++component) {
                const Eigen::VectorXd weight = difference.row(component).transpose();
                read |= reads_of(weight);
                if (weight.norm() > negligible) rows.push_back({reads.size(), weight, sigmas * weight.norm()});
            }
            reads.push_back(read);
        }
    return std::make_unique<PatternJudge>(std::move(rows), std::move(reads));
}

}  // namespace

JudgeFactory method(const fdi::DetectorSettings& settings)
{
    return [settings](const geometry::SensorCluster& cluster, const Faults&) { return std::make_unique<MethodJudge>(settings, cluster); };
}

JudgeFactory likelihood_of_known_count()
{
    return
        [](const geometry::SensorCluster& cluster, const Faults& faults) { return std::make_unique<KnownCount>(cluster, faults, false); };
}

JudgeFactory posterior_of_known_count()
{
    return [](const geometry::SensorCluster& cluster, const Faults& faults) { return std::make_unique<KnownCount>(cluster, faults, true); };
}

JudgeFactory invariants_by_weight_sum(double factor)
{
    return [factor](const geometry::SensorCluster& cluster, const Faults&) { return quadruples(cluster, factor); };
}

JudgeFactory voting_by_component(double sigmas)
{
    return [sigmas](const geometry::SensorCluster& cluster, const Faults&) { return triad_components(cluster, sigmas); };
}

}  // namespace quorient::studies
