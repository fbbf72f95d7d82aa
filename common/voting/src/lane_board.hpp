#pragma once

#include "agreement.hpp"
#include "ballot.hpp"
#include "corroboration.hpp"
#include "lane_tracker.hpp"
#include "levels.hpp"
#include "narrator.hpp"
#include "timeline.hpp"

#include <array>
#include <vector>

namespace quorient::voting {

/// How every lane stands to the output: whether it is excluded and why, for which published frames it vouched, whether it may return.
class LaneBoard {
public:
    LaneBoard(const VoterSettings& settings, std::size_t majority, Corroboration& corroboration, Narrator& narrator);

    std::size_t size() const { return lanes_.size(); }
    const LaneTracker& lane(LaneIndex index) const { return lanes_[index]; }
    const Agreement& agreement() const { return agreement_; }
    const Levels& levels() const { return levels_; }

    /// @returns false for a duplicate.
    bool store(LaneIndex index, const AttitudeState& sample);

    /// A sample that is not an attitude.
    void reject(LaneIndex index, Identity identity);

    /// Excludes the lanes that owe a frame for longer than `silence_ns`.
    void mark_silent(const Timeline& timeline, std::int64_t silence_ns, std::int64_t now_ns);

    /// When the next lane falls silent.
    std::int64_t silence_deadline_ns(const Timeline& timeline, std::int64_t silence_ns) const;

    /// Where every lane is excluded, those that were merely silent or invalid and deliver again count at once: better one than none.
    void release_last_resort(const Timeline& timeline);

    /// The frame is published with this outcome. Labels the lanes and remembers which ones vouched.
    void publish(Identity identity, const Ballot& ballot, bool unseeded_remain, std::int64_t now_ns);

    /// A sample of a frame that is already published: it still vouches.
    void late_vote(LaneIndex index, const AttitudeState& sample, std::int64_t now_ns);

    /// Draws the conclusions from the frame for which no more votes come. After the output is out, so that it never names an excluded
    /// primary.
    void close(Identity newest);

    void start_levels_over() { levels_.clear(); }

    LaneMask blocked() const;
    LaneMask excluded() const;
    bool unseeded_remain() const;

    /// @returns nullptr while this agrees with itself, otherwise what is wrong. For tests.
    const char* broken_invariant() const;

private:
    struct Record {
        Identity identity;
        Ballot ballot;
        bool unseeded_remain = true;
        bool open = false;
    };

    static constexpr std::size_t remembered = 64;

    Record& record(std::uint64_t age) { return records_[(published_ - 1 - age) % remembered]; }
    const Record& record(std::uint64_t age) const { return records_[(published_ - 1 - age) % remembered]; }
    void latch(LaneIndex index, LaneExclusion why, Identity identity, AxisMask axes);
    void label(LaneIndex index, const AttitudeState& sample, const Record& record, std::int64_t now_ns);
    void set_label(LaneIndex index, LaneExclusion why, Identity identity, AxisMask axes);
    void judge(LaneIndex index, const Record& record, bool backed, Identity newest);
    std::optional<std::uint64_t> owed_frame(LaneIndex index, const Timeline& timeline) const;

    std::vector<LaneTracker> lanes_;
    std::size_t majority_;
    unsigned return_frames_;
    unsigned disagreement_frames_;
    std::uint64_t close_after_;  ///< frames
    Agreement agreement_;
    Levels levels_;
    Corroboration& corroboration_;
    Narrator& narrator_;
    std::array<Record, remembered> records_{};
    std::uint64_t published_ = 0;
};

}  // namespace quorient::voting
