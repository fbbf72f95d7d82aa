#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace quorient::monitor {

using Text = std::shared_ptr<const std::string>;

/// One writer, many streams. Each message exists once, however many streams send it; a stream that is slow skips messages,
/// and never holds up the writer or another stream.
class Feed {
public:
    /// What a stream has to send next.
    struct Next {
        Text text;                ///< nothing: the time is over, or the feed is closed
        std::uint64_t number = 0; ///< this message's; the next call continues behind it
        bool joined = false;      ///< messages were skipped (or this is the first): the stream has to begin anew
    };

    void publish(std::string message)
    {
        auto text = std::make_shared<const std::string>(std::move(message));
        const std::lock_guard lock{mutex_};
        ring_[++newest_ % ring_.size()] = std::move(text);
        published_.notify_all();
    }

    /// The message behind `number`, as soon as it is there; the newest for a stream that joins (number 0) or has fallen behind.
    Next wait_behind(std::uint64_t number, std::chrono::milliseconds patience)
    {
        std::unique_lock lock{mutex_};
        published_.wait_for(lock, patience, [&] { return closed_ || newest_ > number; });
        if (closed_ || newest_ <= number) return {nullptr, number, false};
        const bool joined = number == 0 || newest_ - number >= ring_.size();
        const auto next = joined ? newest_ : number + 1;
        return {ring_[next % ring_.size()], next, joined};
    }

    void close()
    {
        const std::lock_guard lock{mutex_};
        closed_ = true;
        published_.notify_all();
    }

    bool closed()
    {
        const std::lock_guard lock{mutex_};
        return closed_;
    }

private:
    std::mutex mutex_;
    std::condition_variable published_;
    std::array<Text, 16> ring_;
    std::uint64_t newest_ = 0;
    bool closed_ = false;
};

}  // namespace quorient::monitor
