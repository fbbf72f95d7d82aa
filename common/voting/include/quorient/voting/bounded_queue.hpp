#pragma once

#include <array>
#include <cstddef>

namespace quorient::voting {

/// First in, first out, at most Capacity waiting; when full the oldest gives way and is counted.
template <class T, std::size_t Capacity>
class BoundedQueue {
public:
    /// A place at the end, to be filled by the caller.
    T& push()
    {
        if (size_ == Capacity) {
            first_ = (first_ + 1) % Capacity;
            --size_;
            ++dropped_;
        }
        return entry_[(first_ + size_++) % Capacity];
    }

    bool pop(T& entry)
    {
        if (size_ == 0) return false;
        entry = entry_[first_];
        first_ = (first_ + 1) % Capacity;
        --size_;
        return true;
    }

    std::size_t dropped() const { return dropped_; }

private:
    std::array<T, Capacity> entry_{};
    std::size_t first_ = 0;
    std::size_t size_ = 0;
    std::size_t dropped_ = 0;
};

}  // namespace quorient::voting
