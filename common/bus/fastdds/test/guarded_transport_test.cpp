#include "../src/guarded_transport.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

namespace quorient::bus::fastdds {

namespace {

/// Keeps each datagram for a while, and counts how many it holds at once.
class Receiver final : public rtps::TransportReceiverInterface {
public:
    void OnDataReceived(const wire::octet*, std::uint32_t, const wire::Locator_t&, const wire::Locator_t&) override
    {
        std::unique_lock lock{mutex_};
        most = std::max(most, ++held_);
        another_.notify_all();
        another_.wait_for(lock, std::chrono::milliseconds{200}, [this] { return most > 1; });
        --held_;
    }

    int most = 0;

private:
    std::mutex mutex_;
    std::condition_variable another_;
    int held_ = 0;
};

/// @returns how many datagrams are with the library at once when one arrives by each port.
int at_once(std::array<std::uint32_t, 2> ports)
{
    const auto descriptor = guarded(std::make_shared<rtps::UDPv4TransportDescriptor>(), std::make_shared<std::atomic<bool>>(true));
    const std::unique_ptr<rtps::TransportInterface> transport{descriptor->create_transport()};
    auto& guard = dynamic_cast<rtps::ChainingTransport&>(*transport);
    std::array<wire::octet, 20> datagram{'R', 'T', 'P', 'S', 2, 3, 1, 15};
    Receiver receiver;
    const auto receive = [&](std::uint32_t port) {
        wire::Locator_t local;
        local.port = port;
        guard.receive(&receiver, datagram.data(), datagram.size(), local, {});
    };
    std::thread other{receive, ports[0]};
    receive(ports[1]);
    other.join();
    return receiver.most;
}

TEST(GuardedTransport, passes_one_datagram_of_discovery_at_a_time)
{
    EXPECT_EQ(at_once({17900, 17910}), 1);
}

TEST(GuardedTransport, does_not_make_samples_wait_for_discovery_nor_for_each_other)
{
    EXPECT_EQ(at_once({17900, 17911}), 2);
    EXPECT_EQ(at_once({17901, 17911}), 2);
}

}  // namespace

}  // namespace quorient::bus::fastdds
