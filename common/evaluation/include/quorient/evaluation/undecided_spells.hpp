#pragma once

#include "quorient/messages/codes.hpp"
#include "quorient/messages/fault_verdict.hpp"

#include <cstddef>
#include <map>
#include <vector>

namespace quorient::evaluation {

/// The times in which a lane's verdicts blamed no axis for good: SUSPECT, AMBIGUOUS, BLIND, PROVISIONAL, SATURATED.
class UndecidedSpells {
public:
    struct Spell {
        VerdictState state = VerdictState::unknown;
        AxisMask axes = 0;  ///< suspects, candidates and those left out provisionally, of the whole spell
        double from_s = 0;  ///< by the log's or the simulation's own time: that of the first such verdict
        double to_s = 0;    ///< that of the last such verdict
    };

    /// @param verdict  the next one of this lane. A spell of the same state that comes back within 0.2 s is continued.
    void add(const FaultVerdict& verdict);

    /// The first `most_spells` ones. All of them are in the totals.
    const std::vector<Spell>& spells() const { return spells_; }
    const std::map<VerdictState, double>& total_s() const { return total_s_; }

    static constexpr std::size_t most_spells = 1000;

private:
    std::vector<Spell> spells_;
    std::map<VerdictState, double> total_s_;
    double newest_s_ = 0;
    bool begun_ = false;
};

}  // namespace quorient::evaluation
