#include "quorient/bus/local_bus.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <deque>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace quorient::bus {

namespace {

struct Sample {
    const void* writer = nullptr;
    std::vector<std::byte> content;
};

/// One topic: its readers, and the history for late joiners.
struct Channel {
    std::vector<std::deque<Sample>*> queues;
    std::deque<Sample> history;
    std::uint32_t writers = 0;
};

/// Keeps the last samples of each writer, as DDS keeps those of each instance: here every writer writes one.
void append(std::deque<Sample>& queue, const void* writer, const void* message, const TopicSpec& topic)
{
    const auto depth = static_cast<std::ptrdiff_t>(topic.qos.depth);
    Sample sample;
    if (std::ssize(queue) >= depth && std::ranges::count(queue, writer, &Sample::writer) >= depth) {
        // The writer's oldest sample leaves, and its memory serves the new one.
        const auto oldest = std::ranges::find(queue, writer, &Sample::writer);
        sample = std::move(*oldest);
        queue.erase(oldest);
    }
    sample.writer = writer;
    sample.content.resize(topic.size);
    std::memcpy(sample.content.data(), message, topic.size);
    queue.push_back(std::move(sample));
}

}  // namespace

struct LocalHub::State {
    std::map<std::string, Channel, std::less<>> channels;
};

namespace {

class LocalWriter final : public Writer {
public:
    LocalWriter(std::shared_ptr<LocalHub::State> state, const TopicSpec& topic)
        : state_(std::move(state)), channel_(state_->channels[topic.name]), topic_(topic)
    {
        ++channel_.writers;
    }
    ~LocalWriter() override { --channel_.writers; }

    bool write(const void* message) override
    {
        if (topic_.qos.transient_local) append(channel_.history, this, message, topic_);
        for (auto* queue : channel_.queues) append(*queue, this, message, topic_);
        return true;
    }

    EndpointStatus status() override
    {
        return {.matched = static_cast<std::uint32_t>(channel_.queues.size()), .transport = Transport::in_process};
    }

private:
    std::shared_ptr<LocalHub::State> state_;
    Channel& channel_;
    TopicSpec topic_;
};

class LocalReader final : public Reader {
public:
    LocalReader(std::shared_ptr<LocalHub::State> state, const TopicSpec& topic)
        : state_(std::move(state)), channel_(state_->channels[topic.name]), size_(topic.size), queue_(channel_.history)
    {
        channel_.queues.push_back(&queue_);
    }
    ~LocalReader() override { std::erase(channel_.queues, &queue_); }

    bool take(void* message) override
    {
        if (queue_.empty()) return false;
        std::memcpy(message, queue_.front().content.data(), size_);
        queue_.pop_front();
        return true;
    }

    EndpointStatus status() override { return {.matched = channel_.writers, .transport = Transport::in_process}; }

private:
    std::shared_ptr<LocalHub::State> state_;
    Channel& channel_;
    std::size_t size_;
    std::deque<Sample> queue_;
};

class LocalBus final : public Bus {
public:
    explicit LocalBus(std::shared_ptr<LocalHub::State> state) : state_(std::move(state)) {}

    /// No other thread can write meanwhile, and time is virtual: there is nothing to wait for.
    void wait(std::int64_t) override {}
    Vendor vendor() const override { return Vendor::local; }

private:
    std::unique_ptr<Writer> make_writer(const TopicSpec& topic, const WriterOptions&) override
    {
        return std::make_unique<LocalWriter>(state_, topic);
    }
    std::unique_ptr<Reader> make_reader(const TopicSpec& topic, const ReaderOptions&) override
    {
        return std::make_unique<LocalReader>(state_, topic);
    }

    std::shared_ptr<LocalHub::State> state_;
};

}  // namespace

LocalHub::LocalHub() : state_(std::make_shared<State>()) {}
LocalHub::~LocalHub() = default;

std::unique_ptr<Bus> LocalHub::open()
{
    return std::make_unique<LocalBus>(state_);
}

}  // namespace quorient::bus
