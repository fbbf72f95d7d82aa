#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/fault_verdict.hpp"

#include <array>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// Turns the assessments of single frames into verdicts, the same way for every method (diagram in common/fdi/README.md).
///
/// Guaranteed, whatever the assessments say:
/// - an axis is isolated only after m of the last n frames, the newest among them, named exactly the same set of axes, and none of
///   these frames knew another set of equal or smaller size that explains it; or after m of the last n frames found it broken;
/// - an isolated axis stays isolated until readmit(): no frame, gap, warm-up or new epoch clears it;
/// - an axis that no explaining set of the last n frames contains is never blamed;
/// - an axis that the method wants out provisionally, or that proves itself broken, is out in this verdict, unless fewer than three axes would
///   be left; it is back as soon as neither is so, or latched. What the method held against it counts no more then; a frame that found it broken
///   counts until it leaves the n;
/// - every verdict is the complete state. Candidate sets are of axes beyond isolated_mask.
///
/// Allocates nothing.
class VerdictMachine {
public:
    static constexpr unsigned max_window = 32;

    /// @param least_axes  with fewer left the verdict is BLIND: 3 where they are directions in space, 1 where a model of the motion
    ///                    stands behind each.
    /// @returns what is wrong with the settings or the number of axes (least_axes to 24).
    static tl::expected<VerdictMachine, std::string> make(const VerdictSettings& settings, std::size_t axis_count,
                                                          std::size_t least_axes = 3);

    /// The state after one more frame. A frame that is not newer than the last one changes nothing.
    /// A new epoch starts the sequences again: what is excluded is then excluded from its sequence 0.
    /// @param broken  axes whose own values prove them faulty in this frame, without any redundancy.
    const FaultVerdict& update(Identity identity, const Assessment& assessment, AxisMask broken = 0);

    /// Takes over exclusions, in sequences of the current epoch. Those already held keep the earlier onset.
    void adopt(const Exclusions& excluded_from);

    /// Trusts these axes again. @returns those that were excluded before.
    AxisMask readmit(AxisMask axes);

    const FaultVerdict& verdict() const { return verdict_; }
    AxisMask isolated() const { return verdict_.isolated_mask; }

private:
    /// What one frame said, reduced to the sets of axes that explain it.
    struct Evidence {
        Outcome outcome = Outcome::healthy;
        bool attributed = false;  ///< explaining[0] is named, and no set of equal or smaller size rivals it
        bool truncated = false;
        AxisMask culprit = 0;
        std::uint8_t count = 0;
        std::array<AxisMask, max_candidates> explaining{};

        bool suspicious() const { return outcome != Outcome::healthy && outcome != Outcome::warming_up; }
        bool undecided() const { return outcome == Outcome::refused || outcome == Outcome::blind; }
        void add(AxisMask set);
    };

    VerdictMachine(const VerdictSettings& settings, std::size_t axis_count, std::size_t least_axes);

    Evidence evidence_of(const Assessment& assessment) const;
    void begin_epoch(std::uint64_t epoch);
    void drop_evidence() { window_size_ = 0; }
    void remember(const Evidence& evidence);
    void isolate_named(const Evidence& newest, std::uint64_t estimated_onset);
    void count_broken(AxisMask broken);
    void latch(AxisMask axes, std::uint64_t onset);
    void leave_out(const Assessment& assessment, AxisMask broken);
    void end_provisional(AxisMask axes);
    void forget_suspicion(AxisMask returning);
    void work_with_the_rest();
    void publish(const Evidence& newest, const Assessment& assessment);
    VerdictState publish_suspicion(const Evidence& suspicion);
    const Evidence* latest_suspicion() const;

    /// The frame `age` frames ago among those that showed anything, 0 = newest.
    const Evidence& past(unsigned age) const { return window_[(window_next_ + max_window - 1 - age) % max_window]; }

    template <class Predicate>
    unsigned count_in_window(Predicate predicate) const;

    VerdictSettings settings_;
    AxisMask all_;
    int least_axes_;
    FaultVerdict verdict_;
    bool started_ = false;
    std::uint64_t frames_ = 0;             ///< in this epoch
    std::uint64_t first_unexplained_ = 0;  ///< the frame after the last one that was judged healthy
    std::array<Evidence, max_window> window_{};
    unsigned window_size_ = 0;
    unsigned window_next_ = 0;
    AxisMask broken_ = 0;                                  ///< not isolated, and found broken in the last n frames
    std::array<std::uint32_t, max_axes> broken_frames_{};  ///< bit k = found broken k frames ago
    std::array<std::uint64_t, max_axes> broken_from_{};
};

}  // namespace quorient::fdi
