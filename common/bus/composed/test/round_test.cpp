// What a composed bus gives to processes outside, and when. The bus under it notes what is written to it.

#include "quorient/bus/composed_bus.hpp"

#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

namespace quorient::bus {

namespace {

struct Written {
    std::string topic;
    std::uint64_t sequence = 0;
    bool operator==(const Written&) const = default;
};

/// For tests: has no peers.
class NotingBus final : public Bus {
public:
    struct Notes {
        std::vector<Written> written;
        bool refuses = false;
        bool waited = false;
    };

    explicit NotingBus(Notes& notes) : notes_(notes) {}

    void wait(std::int64_t /*timeout_ns*/) override { notes_.waited = true; }
    Vendor vendor() const override { return Vendor::local; }

private:
    class NotingWriter final : public Writer {
    public:
        NotingWriter(Notes& notes, const TopicSpec& topic) : notes_(notes), topic_(topic) {}

        bool write(const void* message) override
        {
            const auto sequence = topic_.type == TypeId::fault_verdict ? static_cast<const FaultVerdict*>(message)->sequence
                                                                       : static_cast<const AttitudeState*>(message)->sequence;
            notes_.written.push_back({std::string{topic_.name}, sequence});
            return !notes_.refuses;
        }
        EndpointStatus status() override { return {}; }

    private:
        Notes& notes_;
        const TopicSpec& topic_;
    };

    class SilentReader final : public Reader {
    public:
        bool take(void* /*message*/) override { return false; }
        EndpointStatus status() override { return {}; }
    };

    std::unique_ptr<Writer> make_writer(const TopicSpec& topic, const WriterOptions& /*options*/) override
    {
        return std::make_unique<NotingWriter>(notes_, topic);
    }
    std::unique_ptr<Reader> make_reader(const TopicSpec& /*topic*/, const ReaderOptions& /*options*/) override
    {
        return std::make_unique<SilentReader>();
    }

    Notes& notes_;
};

template <class Message>
Message numbered(std::uint64_t sequence)
{
    Message message;
    message.sequence = sequence;
    return message;
}

class Round : public testing::Test {
protected:
    bool send_verdict(std::uint64_t sequence) { return verdicts.publish(numbered<FaultVerdict>(sequence)); }
    bool send_attitude(std::uint64_t sequence) { return attitudes.publish(numbered<AttitudeState>(sequence)); }

    const std::string verdict{topics::verdict.spec.name}, attitude{topics::attitude.spec.name};
    NotingBus::Notes outside;
    std::unique_ptr<Bus> composed = compose(std::make_unique<NotingBus>(outside));
    Publisher<FaultVerdict> verdicts = composed->advertise(topics::verdict);
    Publisher<AttitudeState> attitudes = composed->advertise(topics::attitude);
};

TEST_F(Round, gives_out_the_end_of_a_chain_before_what_led_to_it)
{
    auto integrator = composed->subscribe(topics::verdict);
    auto voter = composed->subscribe(topics::attitude);
    send_verdict(1);
    send_attitude(1);
    send_verdict(2);
    send_attitude(2);
    FaultVerdict seen;
    EXPECT_TRUE(integrator.take(seen));
    EXPECT_TRUE(outside.written.empty());

    composed->flush();
    EXPECT_EQ(outside.written, (std::vector<Written>{{attitude, 1}, {attitude, 2}, {verdict, 1}, {verdict, 2}}));
    composed->flush();
    EXPECT_EQ(outside.written.size(), 4U);
}

TEST_F(Round, gives_out_at_once_what_nobody_inside_waits_for)
{
    auto integrator = composed->subscribe(topics::verdict);
    send_verdict(1);
    send_attitude(1);
    EXPECT_EQ(outside.written, (std::vector<Written>{{attitude, 1}}));
}

TEST_F(Round, ends_before_the_thread_waits)
{
    auto integrator = composed->subscribe(topics::verdict);
    send_verdict(1);
    FaultVerdict seen;
    EXPECT_TRUE(integrator.take(seen));
    composed->wait(0);
    EXPECT_TRUE(outside.waited);
    EXPECT_EQ(outside.written, (std::vector<Written>{{verdict, 1}}));
}

TEST_F(Round, keeps_the_order_of_a_topic_whose_last_reader_leaves)
{
    {
        auto integrator = composed->subscribe(topics::verdict);
        send_verdict(1);
    }
    send_verdict(2);
    composed->flush();
    EXPECT_EQ(outside.written, (std::vector<Written>{{verdict, 1}, {verdict, 2}}));
}

TEST_F(Round, loses_nothing_however_long_it_lasts)
{
    const std::uint64_t many = 100'000;
    auto integrator = composed->subscribe(topics::verdict);
    for (std::uint64_t sequence = 1; sequence <= many; ++sequence) send_verdict(sequence);
    EXPECT_FALSE(outside.written.empty()) << "an endless queue";
    composed->flush();
    ASSERT_EQ(outside.written.size(), many);
    for (std::uint64_t sequence = 1; sequence <= many; ++sequence) ASSERT_EQ(outside.written[sequence - 1], (Written{verdict, sequence}));
}

TEST_F(Round, reports_what_the_vendor_refused_once_at_the_next_sample)
{
    auto integrator = composed->subscribe(topics::verdict);
    EXPECT_TRUE(send_verdict(1));
    outside.refuses = true;
    composed->flush();
    outside.refuses = false;
    EXPECT_FALSE(send_verdict(2));
    EXPECT_TRUE(send_verdict(3));
    composed->flush();
    EXPECT_TRUE(send_verdict(4));
}

TEST_F(Round, gives_out_what_a_publisher_leaves_behind)
{
    auto integrator = composed->subscribe(topics::verdict);
    {
        auto leaving = composed->advertise(topics::verdict);
        leaving.publish(numbered<FaultVerdict>(1));
    }
    EXPECT_EQ(outside.written, (std::vector<Written>{{verdict, 1}}));
    composed->flush();
    EXPECT_EQ(outside.written.size(), 1U);
}

}  // namespace

}  // namespace quorient::bus
