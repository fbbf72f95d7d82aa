#pragma once

#include <array>
#include <cassert>
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

    /// The oldest; null where there is none.
    const T* front() const { return size_ == 0 ? nullptr : &entry_[first_]; }

    void drop_front()
    {
        assert(size_ > 0);
        first_ = (first_ + 1) % Capacity;
        --size_;
    }

    bool pop(T& entry)
    {
        if (size_ == 0) return false;
        entry = entry_[first_];
        drop_front();
        return true;
    }

    void clear() { size_ = 0; }

    std::size_t size() const { return size_; }

    /// @param index  0 = the oldest
    const T& operator[](std::size_t index) const { return entry_[(first_ + index) % Capacity]; }

    std::size_t dropped() const { return dropped_; }

private:
    std::array<T, Capacity> entry_{};
    std::size_t first_ = 0;
    std::size_t size_ = 0;
    std::size_t dropped_ = 0;
};

}  // namespace quorient::voting
