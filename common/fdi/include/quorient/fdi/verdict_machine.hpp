#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/messages/codes.hpp"
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
/// - an isolated axis stays isolated until readmit(); no frame, gap, warm-up or new epoch clears it;
/// - an axis that no explaining set of the last n frames contains is never blamed;
/// - every verdict is the complete state.
///
/// Allocates nothing.
class VerdictMachine {
public:
    static constexpr unsigned max_window = 32;

    /// @returns what is wrong with the settings or the number of axes (3 to 24).
    static tl::expected<VerdictMachine, std::string> make(const VerdictSettings& settings, std::size_t axis_count);

    /// The state after one more frame. A frame that is not newer than the last one changes nothing.
    /// @param broken  axes whose own values prove them faulty in this frame, without any redundancy.
    const FaultVerdict& update(Identity identity, const Assessment& assessment, AxisMask broken = 0);

    /// Takes over exclusions (in the current epoch's sequences). Those already held keep the earlier onset.
    void adopt(const std::array<std::uint64_t, max_axes>& excluded_from);

    /// Trusts these axes again. @returns those that were excluded before.
    AxisMask readmit(AxisMask axes);

    const FaultVerdict& verdict() const { return verdict_; }
    AxisMask isolated() const { return verdict_.isolated_mask; }

    /// Frames seen of this epoch are fewer than the warm-up asks for.
    bool warming_up() const { return frames_ < settings_.warm_up_frames; }

private:
    /// What one frame said, reduced to the sets that explain it.
    struct Evidence {
        std::uint64_t sequence = 0;
        Outcome outcome = Outcome::healthy;
        bool attributed = false;  ///< `explaining[0]` is named and no set of equal or smaller size rivals it
        bool truncated = false;
        std::uint8_t count = 0;
        std::array<AxisMask, max_candidates> explaining{};
        AxisMask culprit = 0;
    };

    explicit VerdictMachine(const VerdictSettings& settings, std::size_t axis_count);

    Evidence evidence_of(Identity identity, const Assessment& assessment) const;
    void begin_epoch(std::uint64_t epoch);
    void drop_evidence();
    void remember(const Evidence& evidence);
    void isolate_named(const Evidence& newest, std::uint64_t estimated_onset);
    void isolate_broken(std::uint64_t sequence, AxisMask broken);
    void latch(AxisMask axes, std::uint64_t onset);
    void publish(const Evidence& newest, const Assessment& assessment);
    void publish_candidates(const Evidence& newest);

    template <class Predicate>
    unsigned count_in_window(Predicate predicate) const;
    std::uint64_t run_onset() const;

    VerdictSettings settings_;
    AxisMask all_;
    FaultVerdict verdict_;
    std::uint64_t frames_ = 0;  ///< of this epoch
    bool started_ = false;
    std::array<Evidence, max_window> window_{};  ///< ring of the last informative frames
    unsigned window_size_ = 0;
    unsigned window_next_ = 0;
    bool running_ = false;            ///< the window holds a suspicious frame
    std::uint64_t run_begin_ = 0;     ///< first sequence that may be contaminated in this run
    std::array<std::uint32_t, max_axes> broken_frames_{};  ///< shift register: bit 0 = newest frame
    std::array<std::uint64_t, max_axes> broken_begin_{};
};

}  // namespace quorient::fdi
