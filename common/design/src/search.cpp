#include "quorient/design/search.hpp"

#include "assignment.hpp"
#include "quorient/design/mission.hpp"
#include "quorient/design/recognise.hpp"
#include "quorient/geometry/figures.hpp"
#include "quorient/geometry/layouts.hpp"
#include "refine.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <memory>
#include <random>

namespace quorient::design {

namespace {

constexpr std::size_t refined_blindly = 3;
constexpr std::size_t judged_by_survival = 24;

/// What a task of the search found.
struct Found {
    std::shared_ptr<const Arrangement> arrangement;
    Eigen::VectorXd x;
    geometry::Axes axes;
    Figures figures;
};

/// One search.
class Search {
public:
    Search(const Brief& brief, const SearchSettings& settings, const ForEach& for_each)
        : brief_(brief),
          scaled_(brief.with_unit_noise()),
          settings_(settings),
          for_each_(for_each),
          refiner_(scaled_),
          yardstick_(Yardstick::of(brief, settings.seed))
    {
        yardstick_.fault_sizes = is_fault_size(settings.objective);
    }

    tl::expected<SearchResult, Refusal> run(const Bounds& bounds)
    {
        SearchResult result;
        result.bounds = bounds;
        const Choices all = choices(brief_);
        if (all.stands.empty()) choose_places(all.places, result);
        else refine(arrangements(all.stands, settings_.starts), result);
        add_common_choices();
        for_each_(pool_.size(), [&](std::size_t i) { pool_[i].figures = judge(pool_[i].axes, yardstick_); });
        refine_blindly();
        if (const auto kept = keep_front(result); !kept) return tl::unexpected(kept.error());
        return result;
    }

private:
    using Arrangements = std::vector<std::pair<std::shared_ptr<const Arrangement>, Eigen::VectorXd>>;

    /// Every list of stands from so many random starts.
    Arrangements arrangements(const std::vector<std::vector<Stand>>& lists, std::size_t starts) const
    {
        Arrangements all;
        for (std::size_t list = 0; list < lists.size(); ++list)
            for (std::size_t start = 0; start < starts; ++start) {
                std::seed_seq sequence{settings_.seed, static_cast<std::uint64_t>(list), static_cast<std::uint64_t>(start)};
                std::mt19937_64 random(sequence);
                Arrangement arrangement(brief_.kept, brief_.axes_each, lists[list]);
                Eigen::VectorXd x = arrangement.draw(random);
                all.emplace_back(std::make_shared<const Arrangement>(std::move(arrangement)), std::move(x));
            }
        return all;
    }

    void refine(const Arrangements& starts, SearchResult& result)
    {
        const std::vector<Aim> aims = aims_of(scaled_, settings_.objective);
        pool_.resize(starts.size() * aims.size());
        for_each_(pool_.size(), [&](std::size_t task) {
            const auto& [arrangement, start] = starts[task / aims.size()];
            Found& found = pool_[task];
            found.arrangement = arrangement;
            found.x = refiner_.refine(*arrangement, start, aims[task % aims.size()]);
            found.axes = arrangement->axes(found.x);
        });
        result.tried = pool_.size();
    }

    void choose_places(const std::vector<Place>& places, SearchResult& result)
    {
        const Assignments assignments(brief_, places);
        BestAssignments best = best_assignments(scaled_, assignments, settings_, for_each_);
        const bool fixed = std::ranges::all_of(places, &Place::fixed);
        if (fixed) {
            for (const Assignment& assignment : best.found) {
                auto arrangement = std::make_shared<const Arrangement>(brief_.kept, brief_.axes_each, assignments.stands(assignment));
                const Eigen::VectorXd x = arrangement->nominal();
                pool_.push_back({arrangement, x, arrangement->axes(x), {}});
            }
            result.tried = best.tried;
            result.searched = best.searched;
            return;
        }
        refine_choices(assignments, std::move(best.found), result);
    }

    /// Where places leave something free, the best choices by their middle, and random ones, are refined.
    void refine_choices(const Assignments& assignments, std::vector<Assignment> chosen, SearchResult& result)
    {
        std::seed_seq sequence{settings_.seed, std::uint64_t{0x66726565}};
        std::mt19937_64 random(sequence);
        for (std::size_t extra = 0; extra < settings_.starts; ++extra) chosen.push_back(assignments.draw(random));
        for (Assignment& assignment : chosen)
            if (brief_.noise.size() < 2) std::ranges::sort(assignment);
        std::ranges::sort(chosen);
        chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
        std::vector<std::vector<Stand>> lists;
        for (const Assignment& assignment : chosen) lists.push_back(assignments.stands(assignment));
        refine(arrangements(lists, std::max<std::size_t>(1, settings_.starts / lists.size())), result);
    }

    /// No aim leads to the arrays that survive longest: which failures are isolated decides, and accuracy hardly. Cones are among the best.
    void add_common_choices()
    {
        const bool any_cone = std::holds_alternative<FreeMounting>(brief_.mounting) && brief_.axes_each == 1 && brief_.kept.rows() == 0 &&
                              brief_.minimum_angle_rad == 0;
        if (settings_.objective != Objective::survival || !any_cone) return;
        for (const char* family : {"cone", "cone-axis"})
            if (const auto cone = geometry::layout(fmt::format("{}-{}", family, brief_.axis_count()))) pool_.push_back({nullptr, {}, cone->axes, {}});
    }

    void sort_pool()
    {
        std::ranges::stable_sort(pool_, [&](const Found& first, const Found& second) {
            const double missing = shortfall(first.figures, brief_), other = shortfall(second.figures, brief_);
            if (missing != other && (missing == 0 || other == 0)) return missing == 0;
            const bool names = names_failures(first.figures, brief_);
            if (names != names_failures(second.figures, brief_)) return names;
            return better(first.figures, second.figures, settings_.objective);
        });
    }

    void refine_blindly()
    {
        if (has_derivatives(settings_.objective) || settings_.objective == Objective::survival) return;
        sort_pool();
        const std::size_t count = std::min(refined_blindly, pool_.size());
        std::vector<Found> refined(pool_.begin(), pool_.begin() + static_cast<std::ptrdiff_t>(count));
        for_each_(count, [&](std::size_t i) {
            Found& found = refined[i];
            found.x = refiner_.refine_blindly(*found.arrangement, found.x, settings_.objective, yardstick_);
            found.axes = found.arrangement->axes(found.x);
            found.figures = judge(found.axes, yardstick_);
        });
        pool_.insert(pool_.end(), refined.begin(), refined.end());
    }

    /// What is better in everything else may survive less long: there only designs that are alike leave.
    bool beats(const Figures& better, const Figures& other) const
    {
        const auto objective = settings_.objective;
        return as_good(better, other, objective) && (objective != Objective::survival || as_good(other, better, objective));
    }

    /// Sorted by the objective, each design stays that no better one equals in everything else.
    std::vector<Found> front()
    {
        sort_pool();
        std::vector<Found> kept;
        for (const Found& found : pool_) {
            if (shortfall(found.figures, brief_) > 0) continue;
            if (!kept.empty() && names_failures(kept.front().figures, brief_) && !names_failures(found.figures, brief_)) break;
            const bool beaten = std::ranges::any_of(kept, [&](const Found& other) { return beats(other.figures, found.figures); });
            if (!beaten) kept.push_back(found);
        }
        return kept;
    }

    tl::expected<void, Refusal> keep_front(SearchResult& result)
    {
        std::vector<Found> kept = front();
        const std::size_t most = settings_.objective == Objective::survival ? std::max(settings_.designs, judged_by_survival) : settings_.designs;
        if (kept.size() > most) kept.resize(most);
        for (const Found& found : kept) result.designs.push_back(finished(found));
        if (kept.empty() && !pool_.empty())
            result.nearest.push_back(
                finished(*std::ranges::min_element(pool_, {}, [&](const Found& found) { return shortfall(found.figures, brief_); })));
        if (const auto played = play_missions(result.designs); !played) return played;
        if (settings_.objective == Objective::survival)
            std::ranges::stable_sort(result.designs, {}, [](const Design& design) { return cost(design.figures, Objective::survival); });
        if (result.designs.size() > settings_.designs) result.designs.resize(settings_.designs);
        return {};
    }

    /// All figures, turned to be read where it may be turned.
    Design finished(const Found& found) const
    {
        Design design;
        geometry::Axes axes = found.axes;
        if (std::holds_alternative<FreeMounting>(brief_.mounting) && brief_.kept.rows() == 0) {
            const Upright turned = upright(axes, brief_.axes_each == 1 && brief_.noise.size() < 2);
            axes = turned.axes;
            design.symmetry = turned.symmetry;
        }
        auto cluster = geometry::make_cluster(axes, brief_.instrument_of_axes());
        if (cluster) design.cluster = std::move(*cluster);
        else {  // does not span space: only as the nearest one to what was asked for
            design.cluster.axes = axes;
            design.cluster.instrument = brief_.instrument_of_axes();
        }
        design.cluster.sigma = brief_.noise_of_axes();
        Yardstick complete = yardstick_;
        complete.fault_sizes = true;
        design.figures = judge(axes, complete);
        return design;
    }

    tl::expected<void, Refusal> play_missions(std::vector<Design>& designs) const
    {
        if (!brief_.mission) return {};
        for (Design& design : designs) {
            const auto played = survival(design.cluster, *brief_.mission, settings_.seed, for_each_);
            if (!played) return tl::unexpected(Refusal{"mission", played.error()});
            design.figures.survival = *played;
        }
        return {};
    }

    const Brief& brief_;
    const Brief scaled_;  ///< with the least noise as the unit
    const SearchSettings& settings_;
    const ForEach& for_each_;
    Refiner refiner_;
    Yardstick yardstick_;
    std::vector<Found> pool_;
};

}  // namespace

tl::expected<SearchResult, Refusal> search(const Brief& brief, const SearchSettings& settings, const ForEach& for_each)
{
    const auto allowed = check(brief);
    if (!allowed) return tl::unexpected(allowed.error());
    return Search(brief, settings, for_each).run(*allowed);
}

std::vector<Removal> removals(const geometry::SensorCluster& cluster, bool instruments, unsigned failures, Objective objective)
{
    std::vector<Removal> list;
    const std::size_t units = instruments ? cluster.instrument_name.size() : cluster.size();
    for (std::size_t unit = 0; unit < units; ++unit) {
        const AxisMask left = cluster.all() & ~(instruments ? cluster.axes_of(unit) : axis_bit(unit));
        Yardstick yardstick;
        yardstick.instrument_faults = instruments;
        yardstick.failures = failures;
        std::vector<double> noise;
        for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
            if (!has_axis(left, axis)) continue;
            const std::size_t own = cluster.instrument[axis];
            yardstick.instrument.push_back(instruments && own > unit ? own - 1 : own);
            const double sigma = cluster.sigma(static_cast<Eigen::Index>(axis));
            noise.push_back(sigma > 0 ? sigma : 1);
        }
        yardstick.noise = Eigen::Map<const Eigen::VectorXd>(noise.data(), static_cast<Eigen::Index>(noise.size()));
        list.push_back({unit, judge(geometry::select(cluster.axes, left), yardstick)});
    }
    std::ranges::stable_sort(list, [&](const Removal& first, const Removal& second) { return better(first.figures, second.figures, objective); });
    return list;
}

}  // namespace quorient::design
