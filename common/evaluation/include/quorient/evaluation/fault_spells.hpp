#pragma once

#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/limits.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace quorient::evaluation {

/// Time in which one axis was faulty, or was isolated.
struct Spell {
    std::size_t axis = 0;
    double begin_s = 0;
    std::optional<double> end_s;  ///< absent: to the end of the run
};

/// The spells of all axes, from masks in the order of time.
class Spells {
public:
    /// @param bridge_s  a break that is shorter does not end a spell: a fault that touches no value in a frame still lasts.
    explicit Spells(double bridge_s = 0) : bridge_s_(bridge_s) {}

    void update(AxisMask mask, double time_s);

    const std::vector<Spell>& all() const { return spells_; }

private:
    double bridge_s_;
    AxisMask last_ = 0;
    std::vector<Spell> spells_;
};

/// How one lane, or one method, reacted to one fault.
struct Reaction {
    std::optional<double> detected_s;  ///< first verdict that sees a fault
    std::optional<double> isolated_s;
    std::optional<double> trusted_s;  ///< again
    AxisMask isolated = 0;            ///< all that was isolated at isolated_s

    /// One verdict since the fault of these axes began.
    void update(const FaultVerdict& verdict, AxisMask faulty, double time_s);
};

/// @returns when the fault's axis was isolated within its spell, and trusted again
Reaction reaction(const Spell& fault, const Spells& isolated);

/// The isolations that began while their axis was not faulty.
std::vector<Spell> false_isolations(const Spells& faults, const Spells& isolated);

}  // namespace quorient::evaluation
