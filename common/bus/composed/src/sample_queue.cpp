#include "sample_queue.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace quorient::bus {

namespace {

constexpr std::size_t first_room = 8;

}  // namespace

void SampleQueue::push(const void* sample)
{
    if (count_ == room_ && room_ < most_) grow();
    if (count_ == room_) {
        begin_ = slot(1);
        --count_;
    }
    std::memcpy(memory_.data() + slot(count_) * size_, sample, size_);
    ++count_;
}

bool SampleQueue::pop(void* sample)
{
    if (count_ == 0) return false;
    std::memcpy(sample, at(0), size_);
    begin_ = slot(1);
    --count_;
    return true;
}

void SampleQueue::grow()
{
    const auto room = std::min(most_, std::max(first_room, 2 * room_));
    std::vector<std::byte> memory(room * size_);
    for (std::size_t place = 0; place < count_; ++place) std::memcpy(memory.data() + place * size_, at(place), size_);
    memory_ = std::move(memory);
    room_ = room;
    begin_ = 0;
}

}  // namespace quorient::bus
