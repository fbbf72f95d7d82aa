#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace quorient::record {

/// Samples on their way from the DDS thread to the thread that writes the file. It holds a bounded number of bytes; a sample that finds no room is
/// dropped and counted, so that a slow disk never makes the DDS thread wait. The lock is held to copy one sample, or to swap two buffers.
class SampleQueue {
public:
    explicit SampleQueue(std::size_t capacity_bytes);

    /// What precedes each sample's bytes in a batch.
    struct Header {
        std::uint16_t channel = 0;
        std::uint64_t log_time_ns = 0;
        std::uint32_t size = 0;
    };

    /// DDS thread. @returns false where there was no room.
    bool push(std::uint16_t channel, std::uint64_t log_time_ns, std::span<const std::uint8_t> sample);

    /// No more samples come: take() returns at once.
    void close();

    /// Writing thread: waits so long, or until the queue is half full. Gives all that are there, oldest first, in place of the former batch.
    /// @returns false once the queue is closed and empty.
    bool take(std::vector<std::uint8_t>& batch, std::chrono::milliseconds patience);

    std::uint64_t dropped() const;

    /// Calls function(header, sample) for each sample of a batch.
    template <class Function>
    static void each(std::span<const std::uint8_t> batch, Function&& function);

private:
    const std::size_t capacity_;
    mutable std::mutex mutex_;
    std::condition_variable filling_;
    std::vector<std::uint8_t> bytes_;
    std::uint64_t dropped_ = 0;
    bool closed_ = false;
};

template <class Function>
void SampleQueue::each(std::span<const std::uint8_t> batch, Function&& function)
{
    while (!batch.empty()) {
        Header header;
        std::copy_n(batch.begin(), sizeof header, reinterpret_cast<std::uint8_t*>(&header));
        function(header, batch.subspan(sizeof header, header.size));
        batch = batch.subspan(sizeof header + header.size);
    }
}

}  // namespace quorient::record
