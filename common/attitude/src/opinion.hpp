#pragma once

#include "quorient/attitude/body_increment.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <array>
#include <cstdint>

namespace quorient::attitude {

/// What a verdict says about trust: the part of it that the history keeps with the frame it is about.
struct Opinion {
    std::uint64_t sequence = 0;
    Exclusions excluded_from;
    AxisMask excluded = 0;    ///< axes with an excluded_from
    AxisMask taken_over = 0;  ///< those of them that not the verdict excludes, but the voters did (take_over)
    AxisMask known = 0;       ///< excluded as far as verdicts up to this one say; more than `excluded` where it cannot clear
    AxisMask suspects = 0;
    AxisMask candidates = 0;  ///< union of the candidate sets
    double residual = 0;      ///< largest of the finite residuals [rad]
    VerdictState state = VerdictState::unknown;

    /// Whether an axis that it does not exclude is trusted again. WARMING_UP, AMBIGUOUS and BLIND never clear an exclusion.
    bool clears() const { return state == VerdictState::healthy || state == VerdictState::suspect || state == VerdictState::isolated; }

    /// Sets `known`, given what was known at the frame before.
    void follow(AxisMask known_before)
    {
        const AxisMask own = excluded & ~taken_over;
        known = clears() ? own : own | known_before;
    }

    /// Excludes these axes of another opinion besides its own.
    void take_over(const Opinion& other, AxisMask axes);

    /// An order without meaning, so that of two different opinions on one frame the same one is kept whichever comes first.
    bool precedes(const Opinion& other) const;
};

Opinion opinion_of(const FaultVerdict& verdict);

/// The exclusions of a voted attitude, as an opinion on its frame.
Opinion opinion_of(const VotedAttitude& voted);

/// What is done with one frame.
struct Judgement {
    AxisMask used = 0;
    AttitudeMode mode = AttitudeMode::normal;
    double doubt_rad = 0;  ///< error that a fault in the axes used may add in this frame

    bool operator==(const Judgement&) const = default;
};

/// Design.md section 4, Integrator: a named suspect is left out if three well-conditioned axes remain; the union of the
/// candidates likewise, else mode AMBIGUOUS; BLIND is mode UNTRUSTED. An opinion is overruled where a later verdict has
/// excluded an axis at this frame that it did not know of.
/// @param excluded  axes excluded at this frame by all verdicts delivered
/// @param valid     axes with a usable increment
Judgement judge(const Opinion& opinion, AxisMask excluded, AxisMask valid, bool leave_out_suspects, const BodyIncrement& body);

}  // namespace quorient::attitude
