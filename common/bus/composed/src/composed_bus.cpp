#include "quorient/bus/composed_bus.hpp"

#include "quorient/bus/cyclonedds_bus.hpp"
#include "quorient/bus/fastdds_bus.hpp"
#include "quorient/bus/own_samples.hpp"
#include "sample_queue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace quorient::bus {

namespace {

/// Writers of one topic that a queue has room for at least.
constexpr std::size_t writers_of_a_topic = 64;

class ComposedReader;
class ComposedWriter;

/// What the services of this process share of one topic.
struct Channel {
    std::vector<ComposedReader*> readers;
    std::vector<ComposedWriter*> writers;
};

struct State {
    std::map<std::string, Channel> channels;
    std::size_t waiting = 0;               ///< samples in the readers' queues, of all topics
    std::vector<ComposedWriter*> keeping;  ///< have samples for outside; who has kept them longest comes first
};

/// A reader of the vendor for several readers of this process, which were all there before its first sample was taken.
struct Feed {
    std::unique_ptr<Reader> reader;
    std::vector<ComposedReader*> readers;
    std::uint64_t looks = 0;  ///< how often a reader has looked for samples from outside
};

/// For a reader that wants nothing from outside.
class NothingOutside final : public Reader {
public:
    bool take(void*) override { return false; }
    EndpointStatus status() override { return {}; }
    Sender sender() override { return {}; }
};

class ComposedReader final : public Reader {
public:
    ComposedReader(std::shared_ptr<State> state, std::shared_ptr<Feed> feed, const TopicSpec& topic);
    ~ComposedReader() override;

    bool take(void* message) override;
    EndpointStatus status() override;
    Sender sender() override { return feed_->reader->sender(); }

    void push(const void* message)
    {
        const auto before = queue_.count();
        queue_.push(message);
        state_->waiting += queue_.count() - before;
    }

private:
    bool take_from_outside(void* message);

    std::shared_ptr<State> state_;
    Channel& channel_;
    std::shared_ptr<Feed> feed_;
    SampleQueue queue_;
    std::uint64_t seen_ = 0;  ///< looks of the feed when this reader was polled last
};

class ComposedWriter final : public Writer {
public:
    ComposedWriter(std::shared_ptr<State> state, std::unique_ptr<Writer> outside, const TopicSpec& topic)
        : state_(std::move(state)),
          channel_(state_->channels[topic.name]),
          outside_(std::move(outside)),
          history_(topic.size, topic.qos.transient_local ? static_cast<std::size_t>(topic.qos.depth) : 0),
          kept_(topic.size, writers_of_a_topic * static_cast<std::size_t>(topic.qos.depth))
    {
        channel_.writers.push_back(this);
    }
    ~ComposedWriter() override
    {
        send_kept();
        std::erase(state_->keeping, this);
        std::erase(channel_.writers, this);
    }

    bool write(const void* message) override
    {
        for (auto* reader : channel_.readers) reader->push(message);
        if (keeps_history()) history_.push(message);
        if (channel_.readers.empty() && kept_.count() == 0) return outside_->write(message);
        keep(message);
        return !std::exchange(refused_, false);
    }

    void send_kept()
    {
        for (std::size_t place = 0; place < kept_.count(); ++place) refused_ = !outside_->write(kept_.at(place)) || refused_;
        kept_.clear();
    }

    void assert_liveliness() override { outside_->assert_liveliness(); }

    EndpointStatus status() override
    {
        auto status = outside_->status();
        status.matched += static_cast<std::uint32_t>(channel_.readers.size());
        return status;
    }

    /// For a reader that comes late.
    void give_history_to(ComposedReader& reader) const
    {
        for (std::size_t place = 0; place < history_.count(); ++place) reader.push(history_.at(place));
    }

private:
    bool keeps_history() const { return history_.most() > 0; }

    void keep(const void* message)
    {
        if (kept_.count() == 0) state_->keeping.push_back(this);
        if (kept_.count() == kept_.most()) send_kept();
        kept_.push(message);
    }

    std::shared_ptr<State> state_;
    Channel& channel_;
    std::unique_ptr<Writer> outside_;
    SampleQueue history_;
    SampleQueue kept_;      ///< for outside, until the round is over
    bool refused_ = false;  ///< by the vendor, a kept sample of which the caller has not heard yet
};

ComposedReader::ComposedReader(std::shared_ptr<State> state, std::shared_ptr<Feed> feed, const TopicSpec& topic)
    : state_(std::move(state)),
      channel_(state_->channels[topic.name]),
      feed_(std::move(feed)),
      queue_(topic.size, writers_of_a_topic * static_cast<std::size_t>(topic.qos.depth)),
      seen_(feed_->looks)
{
    channel_.readers.push_back(this);
    feed_->readers.push_back(this);
    for (const auto* writer : channel_.writers) writer->give_history_to(*this);
}

ComposedReader::~ComposedReader()
{
    std::erase(channel_.readers, this);
    std::erase(feed_->readers, this);
    state_->waiting -= queue_.count();
}

bool ComposedReader::take(void* message)
{
    if (queue_.pop(message)) {
        --state_->waiting;
        return true;
    }
    return take_from_outside(message);
}

/// One look for all: a reader looks itself only where no other one has since it was polled last. What comes meanwhile ends the next wait.
bool ComposedReader::take_from_outside(void* message)
{
    if (feed_->looks != seen_) {
        seen_ = feed_->looks;
        return false;
    }
    seen_ = ++feed_->looks;
    if (!feed_->reader->take(message)) return false;
    for (auto* reader : feed_->readers) {
        if (reader != this) reader->push(message);
    }
    return true;
}

EndpointStatus ComposedReader::status()
{
    auto status = feed_->reader->status();
    status.matched += static_cast<std::uint32_t>(channel_.writers.size());
    return status;
}

class ComposedBus final : public Bus {
public:
    explicit ComposedBus(std::unique_ptr<Bus> outside) : outside_(std::move(outside)) {}

    void wait(std::int64_t timeout_ns) override
    {
        flush();
        if (state_->waiting == 0) outside_->wait(timeout_ns);
    }

    void flush() override
    {
        while (!state_->keeping.empty()) {
            auto* writer = state_->keeping.back();
            state_->keeping.pop_back();
            writer->send_kept();
        }
    }

    Vendor vendor() const override { return outside_->vendor(); }
    bool shared_memory_lost() const override { return outside_->shared_memory_lost(); }
    std::vector<Refusal> refusals() override { return outside_->refusals(); }

private:
    std::unique_ptr<Writer> make_writer(const TopicSpec& topic, const WriterOptions& options) override
    {
        auto writer = outside_->make_writer(topic, options);
        if (!is_handed_over(topic)) return writer;
        state_->keeping.reserve(++writers_);
        return std::make_unique<ComposedWriter>(state_, std::move(writer), topic);
    }

    std::unique_ptr<Reader> make_reader(const TopicSpec& topic, const ReaderOptions& options) override
    {
        if (!is_handed_over(topic)) return outside_->make_reader(topic, options);
        return std::make_unique<ComposedReader>(state_, options.reach == Reach::process ? no_feed() : feed_for(topic), topic);
    }

    static std::shared_ptr<Feed> no_feed()
    {
        auto feed = std::make_shared<Feed>();
        feed->reader = std::make_unique<NothingOutside>();
        return feed;
    }

    /// Orders are not shared: a service asks for the sender of the one that it has taken.
    std::shared_ptr<Feed> feed_for(const TopicSpec& topic)
    {
        auto& known = feeds_[topic.name];
        auto feed = known.lock();
        if (feed && feed->looks == 0 && topic.type != TypeId::fault_command) return feed;
        feed = std::make_shared<Feed>();
        feed->reader = outside_->make_reader(topic, {});
        known = feed;
        return feed;
    }

    std::unique_ptr<Bus> outside_;
    std::shared_ptr<State> state_ = std::make_shared<State>();
    std::map<std::string, std::weak_ptr<Feed>> feeds_;
    std::size_t writers_ = 0;  ///< ever made
};

tl::expected<std::unique_ptr<Bus>, std::string> open_vendor(const Settings& settings)
{
    if (settings.vendor == Vendor::fastdds) return open_fastdds(settings, OwnSamples::skipped);
    if (settings.vendor == Vendor::cyclonedds) return open_cyclonedds(settings, OwnSamples::skipped);
    return tl::make_unexpected("a composition needs a DDS vendor: fastdds or cyclonedds");
}

}  // namespace

tl::expected<std::unique_ptr<Bus>, std::string> open_composed(const Settings& settings)
{
    if (const auto found = problems(settings); !found.empty()) return tl::make_unexpected(fmt::format("{}", fmt::join(found, "\n")));
    auto outside = open_vendor(settings);
    if (!outside) return tl::make_unexpected(outside.error());
    return compose(std::move(*outside));
}

std::unique_ptr<Bus> compose(std::unique_ptr<Bus> outside)
{
    return std::make_unique<ComposedBus>(std::move(outside));
}

}  // namespace quorient::bus
