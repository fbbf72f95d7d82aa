#pragma once

#include "field/window_sums.hpp"

#include <algorithm>

namespace quorient::fdi::field {

/// In how many frames in a row each member of a comparison has taken part, up to the newest.
using Ages = std::array<std::uint64_t, max_members>;

/// The frames that have been compared, as far back as the longest window.
class ComparedFrames {
public:
    explicit ComparedFrames(std::size_t members) : members_(members) {}

    void reset()
    {
        count_ = 0;
        ages_.fill(0);
    }

    void add(std::uint64_t sequence, InstrumentSet compared)
    {
        sequences_[count_ % sequences_.size()] = sequence;
        ++count_;
        for (std::size_t m = 0; m < members_; ++m) ages_[m] = compared.has(m) ? ages_[m] + 1 : 0;
    }

    std::uint64_t count() const { return count_; }
    const Ages& ages() const { return ages_; }

    /// What was compared before says nothing of this member, or of any.
    void begin_again(std::size_t m) { ages_[m] = 0; }
    void begin_again() { ages_.fill(0); }

    /// Sequence of the oldest frame of a window that ends with the newest one.
    std::uint64_t begin_of(std::size_t window) const { return sequences_[(count_ - window) % sequences_.size()]; }

    /// The longest window that is full, up to the longest of all.
    std::size_t longest() const { return std::min<std::size_t>(count_, longest_window); }

private:
    std::size_t members_;
    std::uint64_t count_ = 0;
    Ages ages_{};
    std::array<std::uint64_t, ring_length> sequences_{};
};

/// The newest three frames, oldest first: the middle one is compared once its successor is known.
template <class Frame>
class ThreeFrames {
public:
    void clear() { count_ = 0; }
    std::size_t count() const { return count_; }
    bool complete() const { return count_ == frames_.size(); }

    const Frame& operator[](std::size_t k) const { return frames_[k]; }
    const Frame& newest() const { return frames_[count_ - 1]; }

    /// The place of a new frame; the oldest of three makes room for it.
    Frame& add()
    {
        if (complete()) {
            frames_[0] = frames_[1];
            frames_[1] = frames_[2];
            --count_;
        }
        return frames_[count_++];
    }

private:
    std::array<Frame, 3> frames_{};
    std::size_t count_ = 0;
};

}  // namespace quorient::fdi::field
