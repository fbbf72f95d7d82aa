#pragma once

#include "quorient/bus/reader_options.hpp"
#include "quorient/bus/refusals.hpp"
#include "quorient/bus/sender.hpp"
#include "quorient/bus/settings.hpp"
#include "quorient/bus/topics.hpp"

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace quorient::bus {

/// A vendor refused to create an entity. A fault of the environment, at start-up only.
class Error : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// How an endpoint stands with its peers.
struct EndpointStatus {
    std::uint32_t matched = 0;
    std::uint32_t incompatible = 0;            ///< peers with an incompatible QoS, in total
    std::string_view policy{};                 ///< name of the policy of the latest of them
    Transport transport = Transport::unknown;  ///< really in use at this end; a peer without it is served by UDP
    Transport asked = Transport::unknown;      ///< requested by the settings for such a topic
    std::uint64_t refused = 0;                 ///< samples that the vendor did not take from us, in total
};

/// Implemented by each vendor. One thread uses a bus and everything that it made.
class Writer {
public:
    virtual ~Writer() = default;
    /// @param message  the plain struct of the topic. @returns false where the vendor refused it.
    virtual bool write(const void* message) = 0;
    /// Asserts this writer's liveliness (exclusive topics).
    virtual void assert_liveliness() {}
    virtual EndpointStatus status() = 0;
};

class Reader {
public:
    virtual ~Reader() = default;
    /// Takes the oldest sample. @returns false when there is none.
    virtual bool take(void* message) = 0;
    virtual EndpointStatus status() = 0;
    /// The writer of the sample taken last. Slow: for rare samples.
    virtual Sender sender() { return {}; }
};

template <class Message>
class Publisher {
public:
    explicit Publisher(std::unique_ptr<Writer> writer) : writer_(std::move(writer)) {}

    bool publish(const Message& message) { return writer_->write(&message); }
    void assert_liveliness() { writer_->assert_liveliness(); }
    EndpointStatus status() { return writer_->status(); }

private:
    std::unique_ptr<Writer> writer_;
};

template <class Message>
class Subscription {
public:
    explicit Subscription(std::unique_ptr<Reader> reader) : reader_(std::move(reader)) {}

    bool take(Message& message) { return reader_->take(&message); }
    EndpointStatus status() { return reader_->status(); }
    Sender sender() { return reader_->sender(); }

private:
    std::unique_ptr<Reader> reader_;
};

/// Typed publish and subscribe over one vendor.
class Bus {
public:
    virtual ~Bus() = default;

    /// @throws Error where the vendor refuses the entity.
    template <class Message>
    Publisher<Message> advertise(const Topic<Message>& topic, const WriterOptions& options = {})
    {
        return Publisher<Message>{make_writer(topic.spec, options)};
    }

    /// @throws Error where the vendor refuses the entity.
    template <class Message>
    Subscription<Message> subscribe(const Topic<Message>& topic, const ReaderOptions& options = {})
    {
        return Subscription<Message>{make_reader(topic.spec, options)};
    }

    /// Gives out what the bus keeps back while a round of the event loop lasts. The loop calls it after each round; wait() does the same.
    virtual void flush() {}

    /// Blocks until a reader of this bus may have data, or the time is over. May return early: Cyclone DDS does not wait where no
    /// subscription could end it.
    virtual void wait(std::int64_t timeout_ns) = 0;

    virtual Vendor vendor() const = 0;

    /// Whether the shared memory that this bus joined has lost its daemon. Processes that share it already keep exchanging samples; a
    /// process that starts later does not join them.
    virtual bool shared_memory_lost() const { return false; }

    /// Whom this bus refused since the last call: by DDS Security, or for another wire contract. Each text comes once.
    virtual std::vector<Refusal> refusals() { return {}; }

    // Endpoints without their type: for advertise(), subscribe(), and a bus that is made of another one.
    virtual std::unique_ptr<Writer> make_writer(const TopicSpec& topic, const WriterOptions& options) = 0;
    virtual std::unique_ptr<Reader> make_reader(const TopicSpec& topic, const ReaderOptions& options) = 0;
};

/// Joins the bus that `settings` names. Vendor::local makes a bus of its own (see local_bus.hpp for a shared one).
/// @returns every problem found before the vendor is touched, or the vendor's own refusal, one per line.
tl::expected<std::unique_ptr<Bus>, std::string> open(const Settings& settings);

}  // namespace quorient::bus
