#include "refine.hpp"

#include "failure_sets.hpp"
#include "quorient/design/bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace quorient::design {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double isotropic = 1e-9;        // above the bound of the trace, relative
/// Shares of the trace that are given up where the best one is not isotropic: in steps, since at its best the trace has no slope.
constexpr std::array<double, 4> given_up{1e-3, 1e-4, 1e-5, 1e-6};

/// Several sets of terms, one below the other.
Terms stacked(const std::vector<Terms>& parts, Index axes)
{
    Index count = 0;
    for (const Terms& part : parts) count += part.value.size();
    Terms all(count, axes);
    Index next = 0;
    for (const Terms& part : parts) {
        all.value.segment(next, part.value.size()) = part.value;
        all.gradient.middleRows(next, part.value.size()) = part.gradient;
        next += part.value.size();
    }
    return all;
}

}  // namespace

bool has_derivatives(Objective objective)
{
    switch (objective) {
        case Objective::trace:
        case Objective::volume:
        case Objective::worst_trace:
        case Objective::worst_volume:
        case Objective::minimum_angle:
        case Objective::f_d1:
        case Objective::f_d2: return true;
        default: return false;
    }
}

std::vector<Aim> aims_of(const Brief& brief, Objective objective)
{
    const unsigned most = brief.judged_failures();
    const bool redundant = brief.axis_count() > 3;
    std::vector<Aim> aims;
    for (const bool keep_accuracy : {true, false}) {
        for (unsigned k = most; k >= 1; --k) aims.push_back({Objective::worst_trace, k, keep_accuracy, 0});
        if (redundant) aims.push_back({Objective::f_d2, 0, keep_accuracy, 0});
        aims.push_back({Objective::minimum_angle, 0, keep_accuracy, 0});
    }
    for (const double allowed : {1.005, 1.02, 1.06})
        if (most > 0) aims.push_back({Objective::worst_trace, most, false, allowed * bounds(brief).trace});
    const bool known = std::ranges::any_of(aims, [&](const Aim& aim) { return aim.objective == objective; });
    if (has_derivatives(objective) && !known && (redundant || objective != Objective::f_d1)) aims.push_back({objective, most, false, 0});
    return aims;
}

Refiner::Refiner(const Brief& brief) : brief_(brief), weight_(brief.noise_of_axes().cwiseInverse()), best_trace_(bounds(brief).trace)
{
    const auto instrument = brief.instrument_of_axes();
    const auto units = axes_of_units(instrument, !brief.instrument_faults);
    for (unsigned k = 0; k <= brief.judged_failures(); ++k) removed_.push_back(failure_sets(units, k));
    for (std::size_t i = 0; i < instrument.size(); ++i)
        for (std::size_t j = i + 1; j < instrument.size(); ++j)
            if (instrument[i] != instrument[j] && j >= static_cast<std::size_t>(brief.kept.rows()))
                pairs_.emplace_back(static_cast<Index>(i), static_cast<Index>(j));
}

geometry::Axes Refiner::whitened(const geometry::Axes& axes) const
{
    return weight_.asDiagonal() * axes;
}

Terms Refiner::by_axes(Terms by_rows) const
{
    for (Index column = 0; column < by_rows.gradient.cols(); ++column) by_rows.gradient.col(column) *= weight_(column % weight_.size());
    return by_rows;
}

Terms Refiner::terms(const geometry::Axes& axes, const Aim& aim) const
{
    switch (aim.objective) {
        case Objective::volume: return by_axes(volume_terms(whitened(axes), removed_[0]));
        case Objective::worst_trace: return by_axes(trace_terms(whitened(axes), removed_[aim.failures]));
        case Objective::worst_volume: return by_axes(volume_terms(whitened(axes), removed_[aim.failures]));
        case Objective::minimum_angle: return cosine_terms(axes, pairs_);
        case Objective::f_d1: return by_axes(visibility_terms(whitened(axes)));
        case Objective::f_d2: return by_axes(rivalry_terms(whitened(axes)));
        default: return by_axes(trace_terms(whitened(axes), removed_[0]));
    }
}

Values Refiner::of_axes(const Arrangement& arrangement, std::function<Terms(const geometry::Axes&)> terms) const
{
    return [&arrangement, terms = std::move(terms)](const VectorXd& x, VectorXd& values, MatrixXd* derivative) {
        const Terms found = terms(arrangement.axes(x));
        values = found.value;
        if (derivative != nullptr) *derivative = found.gradient * arrangement.derivative(x);
    };
}

/// What must hold after 0, 1, 2, … failures, as terms that may not be above 0. A condition has no derivative and is judged afterwards.
Terms Refiner::limits(const geometry::Axes& axes) const
{
    std::vector<Terms> parts;
    for (const Limit& limit : brief_.limits) {
        if (limit.failures >= removed_.size()) continue;
        const Objective trace = limit.failures == 0 ? Objective::trace : Objective::worst_trace;
        const Objective volume = limit.failures == 0 ? Objective::volume : Objective::worst_volume;
        if (limit.trace) {
            parts.push_back(terms(axes, {trace, limit.failures}));
            parts.back().value.array() -= *limit.trace;
        }
        if (limit.volume) {
            parts.push_back(terms(axes, {volume, limit.failures}));
            parts.back().value.array() -= std::log(*limit.volume);
        }
    }
    return stacked(parts, axes.rows());
}

Values Refiner::constraints(const Arrangement& arrangement, const Aim& aim) const
{
    const auto of_axes_terms = of_axes(arrangement, [this, aim](const geometry::Axes& axes) {
        std::vector<Terms> parts{limits(axes)};
        if (brief_.minimum_angle_rad > 0 && aim.objective != Objective::minimum_angle) {
            parts.push_back(cosine_terms(axes, pairs_));
            parts.back().value.array() -= std::pow(std::cos(brief_.minimum_angle_rad), 2);
        }
        if (aim.trace_at_most > 0) {
            parts.push_back(terms(axes, {}));
            parts.back().value.array() -= aim.trace_at_most;
        }
        return stacked(parts, axes.rows());
    });
    return [&arrangement, of_axes_terms](const VectorXd& x, VectorXd& values, MatrixXd* derivative) {
        VectorXd of_array;
        of_axes_terms(x, of_array, derivative);
        const VectorXd tilts = arrangement.tilt_excess(x);
        values.resize(of_array.size() + tilts.size());
        values << of_array, tilts;
        if (derivative == nullptr) return;
        const MatrixXd upper = *derivative;
        derivative->resize(values.size(), x.size());
        *derivative << upper, arrangement.tilt_excess_derivative(x);
    };
}

VectorXd Refiner::refine(const Arrangement& arrangement, const VectorXd& start, const Aim& aim) const
{
    const Values aimed = of_axes(arrangement, [this, aim](const geometry::Axes& axes) { return terms(axes, aim); });
    if (!aim.keep_accuracy) return minimise({aimed, {}, constraints(arrangement, aim)}, start);

    const Aim accuracy{};
    const Values trace = of_axes(arrangement, [&](const geometry::Axes& axes) { return terms(axes, accuracy); });
    const VectorXd accurate = minimise({trace, {}, constraints(arrangement, accuracy)}, start);
    VectorXd reached;
    trace(accurate, reached, nullptr);
    if (reached(0) > best_trace_ * (1 + isotropic)) return keep_trace(arrangement, accurate, aim, reached(0));
    const Values alike = of_axes(arrangement, [this](const geometry::Axes& axes) { return by_axes(anisotropy_terms(whitened(axes))); });
    return minimise({aimed, alike, constraints(arrangement, aim)}, accurate);
}

VectorXd Refiner::keep_trace(const Arrangement& arrangement, VectorXd x, Aim aim, double trace) const
{
    const Values aimed = of_axes(arrangement, [this, aim](const geometry::Axes& axes) { return terms(axes, aim); });
    for (const double share : given_up) {
        aim.trace_at_most = trace * (1 + share);
        x = minimise({aimed, {}, constraints(arrangement, aim)}, x);
    }
    return x;
}

VectorXd Refiner::refine_blindly(const Arrangement& arrangement, const VectorXd& start, Objective objective, const Yardstick& yardstick) const
{
    const auto cost = [&](const VectorXd& x) { return single_cost(arrangement.axes(x), yardstick, objective); };
    return minimise_without_derivatives(cost, constraints(arrangement, {}), start, 0.05);
}

}  // namespace quorient::design
