#pragma once

#include "opinion.hpp"
#include "quorient/attitude/update.hpp"

#include <cassert>
#include <cstdint>
#include <vector>

namespace quorient::attitude {

/// How far an attitude may be trusted for good. It only gets worse, until the attitude is aligned anew: by a reset, or at the stated start
/// of an epoch.
enum class Alignment : std::uint8_t {
    sound,
    untrusted,  ///< all instruments were saturated at a frame since
    lost,       ///< the rotation since the last good frame is not known
};

/// Where the integration stands at the end of a frame.
struct Standing {
    Quaternion attitude = Quaternion::Identity();
    std::uint64_t count = 0;  ///< samples since the last start of the update algorithm; 0 = none
    double interval_s = 0;
    double rate_rad_s = 0;      ///< norm, of the newest frame with a known rotation
    double variance = 0;        ///< angle error by noise, trace of the covariance [rad^2]
    double systematic_rad = 0;  ///< what does not average out: coasting, coning inside gaps, doubtful axes
    double coasting_s = 0;      ///< without a break, up to this frame
    Alignment alignment = Alignment::sound;
};

/// At the end of the frame of a voted attitude that is taken over.
Standing standing_of(const VotedAttitude& voted);

/// One interval of the history: a frame, or the frames of one gap taken together.
struct Record {
    // What was received.
    std::uint64_t first_sequence = 0;
    std::uint64_t last_sequence = 0;
    double interval_s = 0;
    std::array<double, max_axes> increment{};  ///< raw, per axis; 0 where not valid
    AxisMask valid = 0;
    bool bridge = false;       ///< stands for frames that never arrived
    bool own_opinion = false;  ///< the opinion is on this frame, not carried from an earlier one
    Opinion opinion;

    // What follows from it (trust.hpp, opinion.hpp).
    AxisMask excluded = 0;
    AxisMask isolated = 0;  ///< the excluded axes that do not return by themselves
    Judgement judgement;
    Eigen::Vector3d body = Eigen::Vector3d::Zero();  ///< increment of the body from the axes used [rad]
    double variance = 0;                             ///< that increment's at the nominal interval, by noise [rad^2]
    double quantum_variance = 0;                     ///< by a quantiser's remainder, which does not grow [rad^2]

    // Integrated.
    Standing standing;

    /// Writes the body increment and its variances, by this solution for the axes used.
    void combine(const BodyIncrement::Solution& solution);
};

/// The newest records, oldest first, and what was in force before the oldest one. Records follow one another without a break in their
/// sequences. Allocates once.
class History {
public:
    History(std::size_t capacity, const Standing& start) : slots_(capacity), start_(start) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    bool full() const { return size_ == slots_.size(); }

    /// Whether records have left since the history began: a verdict may reach further back than it does.
    bool is_cut() const { return cut_; }

    Record& operator[](std::size_t index) { return slots_[(head_ + index) % slots_.size()]; }
    const Record& operator[](std::size_t index) const { return slots_[(head_ + index) % slots_.size()]; }
    const Record& oldest() const { return (*this)[0]; }
    const Record& newest() const { return (*this)[size_ - 1]; }

    /// Where the integration stood before this record, and the opinion then in force. An index of size() asks for the newest.
    const Standing& standing_before(std::size_t index) const { return index == 0 ? start_ : (*this)[index - 1].standing; }
    const Opinion& opinion_before(std::size_t index) const { return index == 0 ? opinion_at_start_ : (*this)[index - 1].opinion; }

    /// A new newest record, without content.
    Record& append()
    {
        assert(!full());
        Record& record = (*this)[size_++];
        record = Record{};
        return record;
    }

    /// The oldest record leaves. What it came to is in force before the next one.
    void drop_oldest();

    /// No records, and this before the first one to come.
    void restart(const Standing& start, const Opinion& opinion);

    /// What comes before the oldest record is this, whatever was computed: corrections do not reach further back.
    void begin_at(const Standing& start);

    /// The axes that the voters isolate are known to be excluded before the oldest record.
    void know_before(AxisMask axes) { opinion_at_start_.known |= axes; }

    /// Index of the record that covers this sequence; size() where there is none.
    std::size_t find(std::uint64_t sequence) const;

    /// Puts an opinion on the record of its frame. @returns false where that record has the same or a preferred one already.
    bool place(const Opinion& opinion, std::size_t index);

    /// From this record on: an opinion stays in force until the next frame that has its own, and what it knows until one that clears.
    /// @returns the first record that this does not touch.
    std::size_t carry_opinions(std::size_t index);

private:
    std::vector<Record> slots_;  // ring; size_ of them are in use, from head_ on
    std::size_t head_ = 0;
    std::size_t size_ = 0;
    Standing start_;            // where the integration stood before the oldest record
    Opinion opinion_at_start_;  // in force before the oldest record
    bool cut_ = false;
};

}  // namespace quorient::attitude
