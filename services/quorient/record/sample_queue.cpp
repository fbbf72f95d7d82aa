#include "sample_queue.hpp"

namespace quorient::record {

SampleQueue::SampleQueue(std::size_t capacity_bytes) : capacity_(capacity_bytes)
{
    bytes_.reserve(capacity_);
}

bool SampleQueue::push(std::uint16_t channel, std::uint64_t log_time_ns, std::span<const std::uint8_t> sample)
{
    bool is_filling = false;
    const Header header{channel, log_time_ns, static_cast<std::uint32_t>(sample.size())};
    const auto* const image = reinterpret_cast<const std::uint8_t*>(&header);
    {
        const std::lock_guard lock{mutex_};
        if (bytes_.size() + sizeof header + sample.size() > capacity_) {
            ++dropped_;
            return false;
        }
        bytes_.insert(bytes_.end(), image, image + sizeof header);
        bytes_.insert(bytes_.end(), sample.begin(), sample.end());
        is_filling = bytes_.size() > capacity_ / 2;
    }
    if (is_filling) filling_.notify_one();
    return true;
}

void SampleQueue::close()
{
    const std::lock_guard lock{mutex_};
    closed_ = true;
    filling_.notify_one();
}

bool SampleQueue::take(std::vector<std::uint8_t>& batch, std::chrono::milliseconds patience)
{
    batch.clear();
    batch.reserve(capacity_);
    std::unique_lock lock{mutex_};
    filling_.wait_for(lock, patience, [this] { return closed_ || bytes_.size() > capacity_ / 2; });
    std::swap(batch, bytes_);
    return !closed_ || !batch.empty();
}

std::uint64_t SampleQueue::dropped() const
{
    const std::lock_guard lock{mutex_};
    return dropped_;
}

}  // namespace quorient::record
