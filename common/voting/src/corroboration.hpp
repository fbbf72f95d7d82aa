#pragma once

#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/limits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace quorient::voting {

/// What the lanes' detectors report: which axes a majority of them names, and whether there is a suspicion.
///
/// A detector reports an axis that its newest verdict calls SUSPECT, ISOLATED or a candidate, or that it or its lane's attitude leaves out,
/// for good or provisionally. What it isolated stays reported while it is silent, since a dead detector readmits nothing. The rest is
/// dropped then.
class Corroboration {
public:
    Corroboration(std::size_t lanes, std::size_t majority, unsigned settle_frames, unsigned reopen_frames, std::int64_t silence_ns)
        : lanes_(lanes), majority_(majority), settle_frames_(settle_frames), reopen_frames_(reopen_frames), silence_ns_(silence_ns)
    {
    }

    /// @param newest the newest frame known to the voter; verdicts far ahead of it are not believed.
    /// @returns false where the verdict was old, repeated, or of a frame that cannot be.
    bool on_verdict(std::size_t lane, const FaultVerdict& verdict, Identity newest, std::int64_t now_ns);

    /// The masks of a lane's newest attitude.
    void on_sample(std::size_t lane, const AttitudeState& sample, std::int64_t now_ns);

    /// A frame was published: a suspicion that a majority shares holds the settle time open.
    void on_published(Identity identity, std::int64_t now_ns);

    /// A detector that reported no longer ago than this counts.
    void keep_pace(std::int64_t silence_ns) { silence_ns_ = silence_ns; }

    AxisMask corroborated(std::int64_t now_ns) const;

    /// From the first SUSPECT until settle time.
    bool settling(Identity identity) const { return identity.epoch == settle_epoch_ && identity.sequence < settle_until_; }

    bool reports(std::size_t lane, std::int64_t now_ns) const;
    bool has_judged(std::size_t lane, Identity identity) const { return lane_reports_[lane].identity >= identity; }

    /// The lane, or its detector, has isolated axes that a majority reports and that `left_out` lacks.
    bool knows_better(std::size_t lane, AxisMask left_out, std::int64_t now_ns) const;

    /// What the lane's detector has isolated or the lane itself leaves out for good.
    AxisMask held_out(std::size_t lane) const { return lane_reports_[lane].isolated | lane_reports_[lane].applied; }

    /// The detector says that no further fault could be detected.
    bool redundancy_exhausted(std::size_t lane) const;

private:
    struct LaneReport {
        Identity identity;
        std::int64_t received_ns = 0;
        std::uint64_t opened_at = 0;  ///< frame at which this lane alone last opened the settle time
        AxisMask isolated = 0;        ///< by the verdict
        AxisMask suspected = 0;       ///< by the verdict, or candidates
        AxisMask provisional = 0;     ///< left out by the verdict and not isolated
        AxisMask applied = 0;         ///< isolated by the lane's attitude
        AxisMask doubted = 0;         ///< suspected by the lane's attitude, or left out and not isolated
        bool received = false;
        bool troubled = false;
        bool exhausted = false;
        bool opened_once = false;
    };

    AxisMask reported(const LaneReport& last, std::int64_t now_ns) const;
    void open(LaneReport& last, Identity identity, AxisMask axes, std::int64_t now_ns);
    bool fresh(const LaneReport& last, std::int64_t now_ns) const { return last.received && now_ns - last.received_ns <= silence_ns_; }

    std::array<LaneReport, max_lanes> lane_reports_{};
    std::size_t lanes_;
    std::size_t majority_;
    unsigned settle_frames_;
    unsigned reopen_frames_;
    std::int64_t silence_ns_;
    std::uint64_t settle_epoch_ = 0;
    std::uint64_t settle_until_ = 0;
};

}  // namespace quorient::voting
