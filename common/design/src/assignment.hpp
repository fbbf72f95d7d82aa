#pragma once

#include "places.hpp"
#include "quorient/design/search.hpp"

#include <cstdint>
#include <random>
#include <vector>

namespace quorient::design {

/// For each instrument, which place.
using Assignment = std::vector<std::uint16_t>;

/// The choices of places for a brief's instruments. Where all instruments are alike their order does not count.
class Assignments {
public:
    Assignments(const Brief& brief, std::vector<Place> places);

    /// How many; at most `most` + 1.
    std::size_t count(std::size_t most) const;

    /// Calls visit(assignment) for every one of them, in order, as long as it returns true.
    template <class Visit>
    void for_each(Visit visit) const
    {
        Assignment assignment;
        visit_from(assignment, visit);
    }

    Assignment draw(std::mt19937_64& random) const;

    /// No place, and no face, holds more than it can.
    bool allowed(const Assignment& assignment) const;

    const std::vector<Place>& places() const { return places_; }
    std::vector<Stand> stands(const Assignment& assignment) const;

private:
    template <class Visit>
    bool visit_from(Assignment& assignment, Visit& visit) const
    {
        if (assignment.size() == instruments_) return visit(assignment);
        const std::uint16_t first = alike_ && !assignment.empty() ? assignment.back() : std::uint16_t{0};
        for (std::uint16_t place = first; place < places_.size(); ++place) {
            assignment.push_back(place);
            const bool go_on = !allowed(assignment) || visit_from(assignment, visit);
            assignment.pop_back();
            if (!go_on) return false;
        }
        return true;
    }

    std::vector<Place> places_;
    std::size_t instruments_;
    bool alike_;  ///< the instruments: their order does not count, so places ascend
};

/// The best assignments found, by each of several orders of merit, judged with every free value in its middle.
struct BestAssignments {
    std::vector<Assignment> found;
    std::size_t tried = 0;
    Searched searched = Searched::wholly;
};

BestAssignments best_assignments(const Brief& brief, const Assignments& assignments, const SearchSettings& settings, const ForEach& for_each);

}  // namespace quorient::design
