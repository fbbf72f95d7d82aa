#pragma once

#include "opinion.hpp"
#include "quorient/attitude/update.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace quorient::attitude {

/// Where the integration stands at the end of a frame.
struct Standing {
    Quaternion attitude = Quaternion::Identity();
    std::uint64_t count = 0;  ///< samples since the last start of the update algorithm; 0 = none
    double interval_s = 0;
    double rate_rad_s = 0;      ///< norm, of the newest frame with a known rotation
    double variance = 0;        ///< of the angle error by noise, trace of the covariance [rad^2]
    double systematic_rad = 0;  ///< what does not average out: coasting, coning inside gaps, doubtful axes
    double coasting_s = 0;      ///< without a break, up to this frame
    bool lost = false;
};

/// One interval of the history: a frame, or the frames of one gap taken together.
struct Record {
    // What the wire said.
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
    Judgement judgement;
    Eigen::Vector3d body = Eigen::Vector3d::Zero();  ///< increment of the body from the axes used [rad]

    // Integrated.
    Standing standing;
};

/// The newest records, oldest first. Allocates once.
class History {
public:
    explicit History(std::size_t capacity) : slots_(capacity) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    bool full() const { return size_ == slots_.size(); }

    Record& operator[](std::size_t index) { return slots_[(head_ + index) % slots_.size()]; }
    const Record& operator[](std::size_t index) const { return slots_[(head_ + index) % slots_.size()]; }
    const Record& oldest() const { return (*this)[0]; }
    const Record& newest() const { return (*this)[size_ - 1]; }

    /// A new newest record, its content as the slot was left.
    Record& append()
    {
        assert(!full());
        return (*this)[size_++];
    }

    void drop_oldest()
    {
        assert(!empty());
        head_ = (head_ + 1) % slots_.size();
        --size_;
    }

    void clear() { size_ = 0; }

    /// Index of the record that covers this sequence; size() where there is none.
    std::size_t find(std::uint64_t sequence) const
    {
        std::size_t low = 0;
        std::size_t high = size_;
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            if ((*this)[middle].last_sequence < sequence) low = middle + 1;
            else high = middle;
        }
        return low < size_ && (*this)[low].first_sequence <= sequence ? low : size_;
    }

private:
    std::vector<Record> slots_;
    std::size_t head_ = 0;
    std::size_t size_ = 0;
};

}  // namespace quorient::attitude
