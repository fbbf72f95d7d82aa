#pragma once

#include "history.hpp"
#include "quorient/messages/exclusions.hpp"

#include <array>
#include <cstddef>

namespace quorient::attitude {

/// Which axes were excluded at which frame, as a function of the *set* of verdicts delivered, never of their order.
///
/// In the order of identities, each axis goes through runs: excluded by a verdict, confirmed or revised by the following
/// ones, cleared by one that may clear (Opinion::clears) and does not exclude it. Within a run the newest verdict tells the
/// onset. The axis is excluded at every frame from that onset up to, not including, the frame of the clearing verdict:
/// re-admission forgives the future, not the past.
class Trust {
public:
    /// A verdict about a frame still to come, of this epoch or a later one. When the store is full the farthest one is lost.
    void hear_early(std::uint64_t epoch, const Opinion& opinion);

    /// Takes the newest opinion on these frames out of the store, and forgets older ones. @returns false where there was none.
    bool take_early(std::uint64_t first_sequence, std::uint64_t last_sequence, Opinion& opinion);

    /// Whether verdicts about frames of this epoch still to come are stored.
    bool waiting() const { return early_count_ > 0 && early_epoch_ == epoch_; }

    /// A verdict about a frame that has left the history, or that leaves it now; in any order, the newest counts.
    void hear_old(const Opinion& opinion);

    /// The verdicts stored for frames still to come exclude these axes of another opinion besides their own.
    void take_over(const Opinion& other, AxisMask axes);

    /// A new epoch begins: what is excluded stays so from its first frame on.
    void begin_epoch(std::uint64_t epoch);

    /// Writes Record::excluded of the whole history.
    void fold(History& history);

    /// As of the newest verdict known: first contaminated sequence of each axis, `never` where it is not excluded.
    const Exclusions& latest_from() const { return latest_from_; }

    /// Axes excluded at a frame newer than all verdicts.
    AxisMask excluded_at(std::uint64_t sequence) const;

    /// Axes excluded since before this sequence.
    AxisMask excluded_before(std::uint64_t sequence) const { return sequence == 0 ? 0 : excluded_at(sequence - 1); }

private:
    static constexpr std::size_t early_capacity = 64;

    std::array<Opinion, early_capacity> early_;  // by sequence
    std::size_t early_count_ = 0;
    std::uint64_t early_epoch_ = 0;
    std::uint64_t epoch_ = 0;
    Opinion old_;  // all that left the history, merged
    Exclusions latest_from_;
};

}  // namespace quorient::attitude
