#pragma once

#include "history.hpp"

#include <array>
#include <cstddef>

namespace quorient::attitude {

/// Which axes are excluded at which frame, as a function of the *set* of verdicts received, never of their order.
/// Rules: docs/methods/quaternion_integration.md, "Which axes are used in a frame".
///
/// Isolations that were taken over from the voters are part of it. The lane's own detector may have been away when the fault began, and
/// unable to name it now. Its verdicts therefore do not end such an isolation until it has isolated the axis itself, or the voters have let
/// it go.
class Trust {
public:
    /// A verdict on a frame still to come, of this epoch or a later one. When the store is full the farthest one is lost.
    void keep_early(std::uint64_t epoch, const Opinion& opinion);

    /// Takes the newest opinion on these frames out of the store, and forgets older ones. @returns false where there was none.
    bool take_early(std::uint64_t first_sequence, std::uint64_t last_sequence, Opinion& opinion);

    /// Whether verdicts on frames of this epoch still to come are stored.
    bool has_early() const { return early_count_ > 0 && early_epoch_ == epoch_; }

    /// A verdict on a frame that has left the history, or that leaves it now; in any order, the newest counts.
    void keep_old(const Opinion& opinion);

    /// A new epoch begins: what is excluded stays so from its first frame on, until a verdict of the new epoch clears it.
    void begin_epoch(std::uint64_t epoch);

    /// Isolates what a voted attitude isolates, from now on and in all verdicts that are here already.
    void take_over(const VotedAttitude& voted, History& history);

    /// Adds to a verdict's opinion what was taken over and is not confirmed by the lane's own detector.
    void complete(Opinion& opinion);

    /// The isolations of these axes that were taken over may be ended by a verdict without them.
    void let_go(AxisMask axes) { unconfirmed_ &= ~axes; }

    /// Axes excluded at this frame, which the voters had in use when the attitude of that frame was taken over: their fault is in it.
    AxisMask unknown_to_voters(std::uint64_t sequence) const { return excluded_at(sequence) & ~left_out_by_voters_; }

    /// Whether an opinion on a frame newer than all others would change what is excluded.
    bool changes(const Opinion& opinion) const { return opinion.excluded_from != latest_from_ || opinion.isolated != latest_isolated_; }

    /// Whether any axis was ever excluded. If not, no order of verdicts can matter.
    bool ever_excluded() const { return ever_excluded_; }

    /// Writes Record::excluded and Record::isolated of the whole history.
    void fold(History& history);

    /// As of the newest verdict received: first contaminated sequence of each axis, `never` where it is not excluded.
    const Exclusions& latest_from() const { return latest_from_; }

    /// Axes excluded, or isolated, at a frame newer than all verdicts.
    AxisMask excluded_at(std::uint64_t sequence) const { return latest_from_.mask_at(sequence); }
    AxisMask isolated_at(std::uint64_t sequence) const { return excluded_at(sequence) & latest_isolated_; }

    /// Axes excluded since before this sequence.
    AxisMask excluded_before(std::uint64_t sequence) const { return sequence == 0 ? 0 : excluded_at(sequence - 1); }

private:
    static constexpr std::size_t early_capacity = 64;

    std::array<Opinion, early_capacity> early_;  // on frames still to come; the first early_count_ of them, by sequence
    std::size_t early_count_ = 0;
    std::uint64_t early_epoch_ = 0;    // the epoch of all of them
    std::uint64_t epoch_ = 0;          // the history's
    Opinion old_;                      // all verdicts on frames before the history, merged
    Exclusions latest_from_;           // as of the newest verdict; fold() and begin_epoch() write it
    AxisMask latest_isolated_ = 0;     // likewise: those of its axes that are isolated
    Opinion taken_over_;               // isolations of the newest seed
    AxisMask unconfirmed_ = 0;         // those of them that the lane's own detector has never isolated
    AxisMask left_out_by_voters_ = 0;  // all axes that the newest seed did not use
    bool ever_excluded_ = false;
};

}  // namespace quorient::attitude
