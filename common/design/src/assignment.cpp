#include "assignment.hpp"

#include "arrangement.hpp"
#include "failure_sets.hpp"
#include "numbers.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <boost/random/uniform_int_distribution.hpp>
#include <random>
#include <set>

namespace quorient::design {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;

constexpr double vanishing = 1e-9;    // a det A, or an axis's own W_ii, below it is taken for zero
constexpr double close = 1e-9;        // relative: a demand that is missed by less is met
constexpr double impossible = 1e6;
constexpr std::size_t choices_of_task = 2000;

/// The figures that order assignments, quickly: as in figures.hpp, less is better.
struct Merits {
    double missing = infinity;  ///< by how much the demands are missed, see shortfall
    bool unnamed = false;       ///< a failure that the brief demands is not named
    double trace = infinity;
    std::vector<double> worst;  ///< after 1, 2, … failures
    double rivalry = infinity;  ///< 1 / F_d2
    double cosine = 1;          ///< belongs to the smallest angle
    double objective = infinity;
};

/// Which merit comes first; the others follow in their usual order.
enum class Order : std::uint8_t { objective, trace, worst, rivalry, cosine };
constexpr Order orders[] = {Order::objective, Order::trace, Order::worst, Order::rivalry, Order::cosine};

double rounded_to_decimals(double value)
{
    constexpr double digits = 1e10;
    return std::isfinite(value) ? std::round(value * digits) / digits : value;
}

std::vector<double> key(const Merits& merits, Order order)
{
    std::vector<double> list{rounded_to_decimals(merits.missing), merits.unnamed ? 1.0 : 0.0};
    if (order == Order::objective) list.push_back(rounded_to_decimals(merits.objective));
    if (order == Order::worst && !merits.worst.empty()) list.push_back(rounded_to_decimals(merits.worst.back()));
    if (order == Order::rivalry) list.push_back(rounded_to_decimals(merits.rivalry));
    if (order == Order::cosine) list.push_back(rounded_to_decimals(merits.cosine));
    list.push_back(rounded_to_decimals(merits.trace));
    for (const double worst : merits.worst) list.push_back(rounded_to_decimals(worst));
    list.push_back(rounded_to_decimals(merits.rivalry));
    list.push_back(rounded_to_decimals(merits.cosine));
    return list;
}

/// Judges assignments of one brief.
class QuickJudge {
public:
    QuickJudge(const Brief& brief, const Assignments& assignments, Objective objective)
        : brief_(brief), yardstick_(Yardstick::of(brief, 1)), kept_(brief.kept), objective_(objective), weight_(yardstick_.noise.cwiseInverse())
    {
        const auto own = instrument_axes(brief.axes_each);
        for (const Place& place : assignments.places()) {
            const Matrix3d turned = attitude(place, Eigen::Vector2d::Zero(), place.azimuth_rad, place.lean_rad, place.turn_rad);
            axes_of_place_.emplace_back(own * turned.transpose());
        }
        const auto units = axes_of_units(yardstick_.instrument, !yardstick_.instrument_faults);
        for (unsigned k = 0; k <= yardstick_.failures; ++k) removed_.push_back(failure_sets(units, k));
        yardstick_.fault_sizes = is_fault_size(objective);
        yardstick_.mounting_error_rad = 0;  // too slow for every choice
        judged_in_full_ = brief.detectable > 0 || brief.isolable > 0 ||
                          std::ranges::any_of(brief.limits, [](const Limit& limit) { return limit.volume || limit.condition; });
        const bool by_parity = brief.failures.value_or(0) > 0 && brief.axis_count() > 4;  // see names_failures
        if (by_parity) removed_beyond_ = failure_sets(units, *brief.failures + 1);
    }

    geometry::Axes axes(const Assignment& assignment) const
    {
        geometry::Axes all(static_cast<Index>(yardstick_.instrument.size()), 3);
        all.topRows(kept_.rows()) = kept_;
        Index next = kept_.rows();
        for (const std::uint16_t place : assignment) {
            const auto& own = axes_of_place_[place];
            all.middleRows(next, own.rows()) = own;
            next += own.rows();
        }
        return all;
    }

    Merits operator()(const Assignment& assignment) const
    {
        Merits merits;
        const geometry::Axes unit = axes(assignment);
        const geometry::Axes rows = weight_.asDiagonal() * unit;
        const Matrix3d whole = rows.transpose() * rows;
        merits.trace = trace_of_inverse(whole);
        for (std::size_t k = 1; k < removed_.size(); ++k) merits.worst.push_back(worst_trace(rows, whole, removed_[k]));
        merits.cosine = largest_cosine(unit);
        if (merits.trace < infinity) merits.rivalry = largest_rivalry(rows, whole);
        merits.objective = objective_merit(merits, unit);
        merits.missing = missing(merits, unit);
        merits.unnamed = worst_trace(rows, whole, removed_beyond_) == infinity;
        return merits;
    }

private:
    /// By how much the demands are missed. Judging in full is slow, so it is left to demands that need it.
    double missing(const Merits& merits, const geometry::Axes& unit) const
    {
        if (judged_in_full_) return shortfall(judge(unit, yardstick_), brief_);
        double sum = std::max(0.0, merits.cosine - std::cos(brief_.minimum_angle_rad) - close);
        if (brief_.failures && !merits.worst.empty() && merits.worst.back() == infinity) sum += impossible;
        for (const Limit& limit : brief_.limits) {
            const double reached = limit.failures == 0 ? merits.trace : merits.worst[limit.failures - 1];
            if (limit.trace && reached > *limit.trace * (1 + close)) sum += std::min(impossible, reached / *limit.trace - 1);
        }
        return sum;
    }

    static double trace_of_inverse(const Matrix3d& a)
    {
        const double determinant = a.determinant();
        if (determinant < vanishing) return infinity;
        const double minors = a(0, 0) * a(1, 1) - a(0, 1) * a(0, 1) + a(0, 0) * a(2, 2) - a(0, 2) * a(0, 2) + a(1, 1) * a(2, 2) - a(1, 2) * a(1, 2);
        return minors / determinant;
    }

    static double worst_trace(const geometry::Axes& rows, const Matrix3d& whole, std::span<const AxisMask> removed)
    {
        double worst = 0;
        for (const AxisMask set : removed) {
            Matrix3d left = whole;
            for (Index axis = 0; axis < rows.rows(); ++axis)
                if (has_axis(set, static_cast<std::size_t>(axis))) left -= rows.row(axis).transpose() * rows.row(axis);
            worst = std::max(worst, trace_of_inverse(left));
            if (worst == infinity) break;
        }
        return worst;
    }

    static double largest_cosine(const geometry::Axes& axes)
    {
        double largest = 0;
        for (Index i = 0; i < axes.rows(); ++i)
            for (Index j = i + 1; j < axes.rows(); ++j) largest = std::max(largest, std::abs(axes.row(i).dot(axes.row(j))));
        return largest;
    }

    static double largest_rivalry(const geometry::Axes& rows, const Matrix3d& whole)
    {
        const geometry::AxisMatrix shared = rows * whole.inverse() * rows.transpose();
        double largest = 0;
        for (Index i = 0; i < rows.rows(); ++i) {
            const double own = 1 - shared(i, i);
            if (own < vanishing) return infinity;
            for (Index j = 0; j < rows.rows(); ++j)
                if (i != j) largest = std::max(largest, std::pow(shared(i, j) / own, 2));
        }
        return largest;
    }

    double objective_merit(const Merits& merits, const geometry::Axes& axes) const
    {
        switch (objective_) {
            case Objective::trace:
            case Objective::survival:
            case Objective::mounted_trace: return merits.trace;
            case Objective::worst_trace: return merits.worst.empty() ? merits.trace : merits.worst.back();
            case Objective::f_d2: return merits.rivalry;
            case Objective::minimum_angle: return merits.cosine;
            default: return cost(judge(axes, yardstick_), objective_);
        }
    }

    const Brief& brief_;
    Yardstick yardstick_;
    bool judged_in_full_ = false;
    geometry::Axes kept_;
    Objective objective_;
    geometry::AxisVector weight_;
    std::vector<Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, 3, 3>> axes_of_place_;
    std::vector<std::vector<AxisMask>> removed_;
    std::vector<AxisMask> removed_beyond_;  ///< what may be missing if each demanded failure is named; empty where none is demanded
};

/// The best one by every order of merit.
class Champions {
public:
    void offer(const Assignment& assignment, const Merits& merits)
    {
        for (const Order order : orders) {
            auto& holder = holders_[static_cast<std::size_t>(order)];
            auto own = key(merits, order);
            if (!holder.assignment.empty() && !(own < holder.key)) continue;
            holder = {assignment, std::move(own)};
        }
    }

    void merge(const Champions& other)
    {
        for (std::size_t k = 0; k < holders_.size(); ++k)
            if (!other.holders_[k].assignment.empty() && (holders_[k].assignment.empty() || other.holders_[k].key < holders_[k].key))
                holders_[k] = other.holders_[k];
    }

    std::vector<Assignment> assignments() const
    {
        std::vector<Assignment> list;
        for (const Holder& holder : holders_)
            if (!holder.assignment.empty() && std::ranges::find(list, holder.assignment) == list.end()) list.push_back(holder.assignment);
        return list;
    }

private:
    struct Holder {
        Assignment assignment;
        std::vector<double> key;
    };
    std::array<Holder, std::size(orders)> holders_;
};

Champions merged(const std::vector<Champions>& parts)
{
    Champions all;
    for (const Champions& part : parts) all.merge(part);
    return all;
}

/// One instrument at a time goes to the place where it helps most, until none helps.
void exchange(const QuickJudge& judge, const Assignments& assignments, Assignment current, Order order, Champions& champions, std::size_t& tried)
{
    Merits reached = judge(current);
    champions.offer(current, reached);
    for (bool improved = true; improved;) {
        improved = false;
        Assignment best = current;
        auto least = key(reached, order);
        for (std::size_t instrument = 0; instrument < current.size(); ++instrument)
            for (std::uint16_t place = 0; place < assignments.places().size(); ++place) {
                Assignment next = current;
                next[instrument] = place;
                if (place == current[instrument] || !assignments.allowed(next)) continue;
                ++tried;
                auto own = key(judge(next), order);
                if (!(own < least)) continue;
                least = std::move(own);
                best = next;
                improved = true;
            }
        current = best;
        reached = judge(current);
        champions.offer(current, reached);
    }
}

BestAssignments by_exchange(const QuickJudge& judge, const Assignments& assignments, const SearchSettings& settings, const ForEach& for_each)
{
    const std::size_t tasks = settings.starts * std::size(orders);
    std::vector<Champions> parts(tasks);
    std::vector<std::size_t> tried(tasks);
    for_each(tasks, [&](std::size_t task) {
        std::seed_seq sequence{settings.seed, std::uint64_t{0x706c61636573}, static_cast<std::uint64_t>(task)};
        std::mt19937_64 random(sequence);
        exchange(judge, assignments, assignments.draw(random), orders[task % std::size(orders)], parts[task], tried[task]);
    });
    BestAssignments best{merged(parts).assignments(), 0, Searched::by_exchange};
    for (const std::size_t count : tried) best.tried += count;
    return best;
}

BestAssignments by_enumeration(const QuickJudge& judge, const Assignments& assignments, const ForEach& for_each)
{
    std::vector<Assignment> all;
    assignments.for_each([&](const Assignment& assignment) {
        all.push_back(assignment);
        return true;
    });
    const std::size_t tasks = (all.size() + choices_of_task - 1) / choices_of_task;
    std::vector<Champions> parts(tasks);
    for_each(tasks, [&](std::size_t task) {
        const std::size_t end = std::min(all.size(), (task + 1) * choices_of_task);
        for (std::size_t index = task * choices_of_task; index < end; ++index) parts[task].offer(all[index], judge(all[index]));
    });
    return {merged(parts).assignments(), all.size(), Searched::wholly};
}

}  // namespace

Assignments::Assignments(const Brief& brief, std::vector<Place> places)
    : places_(std::move(places)), instruments_(brief.instruments), alike_(brief.noise.size() < 2)
{
}

std::size_t Assignments::count(std::size_t most) const
{
    std::size_t counted = 0;
    for_each([&](const Assignment&) { return ++counted <= most; });
    return counted;
}

bool Assignments::allowed(const Assignment& assignment) const
{
    const auto on_face = [&](std::size_t face) {
        return std::ranges::count(assignment, face, [&](std::uint16_t other) { return places_[other].face; });
    };
    return std::ranges::all_of(assignment, [&](std::uint16_t place) {
        return places_[place].holds >= instruments_ || static_cast<std::size_t>(on_face(places_[place].face)) <= places_[place].holds;
    });
}

Assignment Assignments::draw(std::mt19937_64& random) const
{
    boost::random::uniform_int_distribution<std::size_t> any(0, places_.size() - 1);
    Assignment assignment;
    while (assignment.size() < instruments_) {
        assignment.push_back(static_cast<std::uint16_t>(any(random)));
        if (!allowed(assignment)) assignment.pop_back();
    }
    return assignment;
}

std::vector<Stand> Assignments::stands(const Assignment& assignment) const
{
    std::vector<Stand> list;
    for (const std::uint16_t place : assignment) list.push_back({places_[place]});
    return list;
}

BestAssignments best_assignments(const Brief& brief, const Assignments& assignments, const SearchSettings& settings, const ForEach& for_each)
{
    const QuickJudge judge(brief, assignments, settings.objective);
    const bool all = settings.places == PlaceSearch::exhaustive ||
                     (settings.places == PlaceSearch::automatic && assignments.count(most_choices) <= most_choices);
    return all ? by_enumeration(judge, assignments, for_each) : by_exchange(judge, assignments, settings, for_each);
}

}  // namespace quorient::design
