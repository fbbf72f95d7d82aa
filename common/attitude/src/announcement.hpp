#pragma once

#include "history.hpp"
#include "quorient/messages/attitude_state.hpp"

#include <algorithm>

namespace quorient::attitude {

/// What others know of the attitude: the standing that is shown, what was published, and the resets that lead from one to the other.
/// While a roll-back is pending, the shown standing follows the old track. The correction then appears as a whole.
class Announcement {
public:
    explicit Announcement(const Standing& start) : shown_(start), published_(start.attitude) {}

    /// At the newest record.
    const Standing& shown() const { return shown_; }
    void show(const Standing& standing) { shown_ = standing; }

    /// Records newer than the newest frame that was published.
    std::size_t unpublished() const { return unpublished_; }
    void one_more_record() { ++unpublished_; }
    void at_most(std::size_t records) { unpublished_ = std::min(unpublished_, records); }

    /// What is shown counts as published: what changes it later is a reset.
    void publish();

    /// Roll-backs that have ended are old news.
    void forget_rolled_back() { rolled_back_frames_ = 0; }

    /// A roll-back has ended with this at the newest record, and with `corrected` at the newest published frame.
    /// @param integrated_again  records, for rolled_back_frames. @param announced  as a reset, if the published attitude has changed.
    void correct(const Standing& newest, const Quaternion& corrected, std::size_t integrated_again, bool announced);

    /// The attitude goes on from this without being integrated from what was published. @param stated  it is a known one: a reset.
    void begin(const Standing& start, bool stated);

    /// Resets go on counting from those of the voted attitude.
    void take_over(std::uint32_t reset_counter, const Quaternion& reset_rotation);

    void write(AttitudeState& state) const;

private:
    Standing shown_;                                      // at the newest record; as announced, not as corrected by a pending roll-back
    Quaternion published_;                                // at the newest published frame, as it was published
    std::size_t unpublished_ = 0;                         // records newer than that frame; never more than the history has
    std::uint32_t reset_counter_ = 0;                     // goes up by one with every reset, or jumps with a seed
    Quaternion reset_rotation_ = Quaternion::Identity();  // the newest reset: new o conj(old) at the newest published frame
    std::uint32_t rolled_back_frames_ = 0;                // by the roll-backs that ended since the last frame was added
};

}  // namespace quorient::attitude
