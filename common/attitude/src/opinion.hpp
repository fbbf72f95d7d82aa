#pragma once

#include "quorient/attitude/body_increment.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/voted_attitude.hpp"

namespace quorient::attitude {

/// What one verdict states about trust: the part of it that the history keeps with its frame.
struct Opinion {
    std::uint64_t sequence = 0;
    Exclusions excluded_from;
    AxisMask excluded = 0;    ///< axes with an excluded_from: isolated, left out provisionally, or taken over
    AxisMask isolated = 0;    ///< those of them that are isolated; the others may count again by themselves
    AxisMask own = 0;         ///< axes that the verdict itself excludes
    AxisMask taken_over = 0;  ///< isolated by the voters (take_over) and not by the verdict
    AxisMask known = 0;       ///< excluded as far as verdicts up to this one state; more than `own` where it clears nothing
    AxisMask suspects = 0;
    AxisMask candidates = 0;  ///< union of the candidate sets
    double residual = 0;      ///< largest of the finite residuals [rad]
    VerdictState state = VerdictState::unknown;

    /// Whether an axis that it does not exclude is trusted again. HEALTHY, SUSPECT, ISOLATED and PROVISIONAL compare the axes and do so.
    /// WARMING_UP, AMBIGUOUS, BLIND and SATURATED have nothing to compare with, so exclusions stay as they are.
    bool clears() const;

    /// Sets `known`, given what was known at the frame before.
    void follow(AxisMask known_before) { known = clears() ? own : own | known_before; }

    /// Isolates these axes of another opinion too, unless it isolates them itself.
    void take_over(const Opinion& other, AxisMask axes);

    /// An order without meaning: of two different opinions on one frame the same one is kept, whichever comes first.
    bool precedes(const Opinion& other) const;
};

Opinion opinion_of(const FaultVerdict& verdict);

/// The isolated axes of a voted attitude, as an opinion on its frame. What is left out provisionally is not taken over.
Opinion opinion_of(const VotedAttitude& voted);

/// What is done with one frame.
struct Judgement {
    AxisMask used = 0;
    AttitudeMode mode = AttitudeMode::normal;
    bool saturated = false;  ///< the true rate is unknown: the attitude is not to be trusted from this frame on
    double doubt_rad = 0;    ///< error that a fault in the axes used may add in this frame

    bool operator==(const Judgement&) const = default;
};

/// Which axes one frame is integrated with: docs/methods/quaternion_integration.md, "Which axes are used in a frame".
/// @param excluded  axes excluded at this frame by all verdicts delivered
/// @param valid     axes with a usable increment
Judgement judge(const Opinion& opinion, AxisMask excluded, AxisMask valid, bool leave_out_suspects, const BodyIncrement& body);

}  // namespace quorient::attitude
