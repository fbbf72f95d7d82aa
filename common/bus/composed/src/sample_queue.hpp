#pragma once

#include <cstddef>
#include <vector>

namespace quorient::bus {

/// The newest samples of one size, oldest first. It grows to the most that it has held at once, and then allocates no more.
class SampleQueue {
public:
    /// @param most  samples; a further one pushes the oldest out
    SampleQueue(std::size_t sample_size, std::size_t most) : size_(sample_size), most_(most) {}

    void push(const void* sample);

    /// @returns false when there is none.
    bool pop(void* sample);

    void clear() { count_ = 0; }

    std::size_t count() const { return count_; }
    std::size_t most() const { return most_; }

    /// @param place  0 is the oldest
    const void* at(std::size_t place) const { return memory_.data() + slot(place) * size_; }

private:
    std::size_t slot(std::size_t place) const { return (begin_ + place) % room_; }
    void grow();

    std::size_t size_;
    std::size_t most_;
    std::vector<std::byte> memory_;
    std::size_t room_ = 0;  ///< samples that fit into memory_
    std::size_t begin_ = 0;
    std::size_t count_ = 0;
};

}  // namespace quorient::bus
