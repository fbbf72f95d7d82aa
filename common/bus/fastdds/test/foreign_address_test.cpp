// An endpoint may listen elsewhere than its node says: Fast DDS 2.9.1 as packaged aborts the process that first sends there.

#include "plain_node.hpp"
#include "quorient/bus/bus.hpp"
#include "quorient/bus/fastdds_bus.hpp"
#include "quorient/bus/topics.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <chrono>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <memory>

namespace quorient::bus {

namespace {

namespace dds = fastdds::dds;
namespace wire = fastdds::wire;

/// A plain node of the vendor on loopback, whose reader of frames listens at addresses that its participant does not announce.
class ForeignReader {
public:
    ForeignReader(std::uint32_t domain, std::uint32_t own_port, std::uint32_t shared_port) : node_(domain, topics::frame.spec)
    {
        dds::DataReaderQos qos;
        qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
        qos.endpoint().unicast_locator_list.push_back(address("127.0.0.1", own_port));
        qos.endpoint().multicast_locator_list.push_back(address("239.255.0.7", shared_port));
        reader_ = node_.participant().create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT)->create_datareader(node_.topic(), qos);
    }

    bool take()
    {
        dds::SampleInfo info;
        return fastdds::is_ok(reader_->take_next_sample(node_.sample(), &info)) && info.valid_data;
    }

private:
    static wire::Locator_t address(const char* host, std::uint32_t port)
    {
        wire::Locator_t locator;
        wire::IPLocator::setIPv4(locator, host);
        locator.port = port;
        return locator;
    }

    fastdds::PlainNode node_;
    dds::DataReader* reader_ = nullptr;
};

TEST(ForeignAddress, of_readers_that_their_nodes_did_not_announce_ends_nobody_and_is_served)
{
    // Within a process Fast DDS would hand samples over without a transport.
    fastdds::deliver_by_transports();

    const std::uint32_t domain = 120 + static_cast<std::uint32_t>(::getpid()) % 100;
    Settings settings;
    settings.vendor = Vendor::fastdds;
    settings.domain = domain;
    const auto bus = open_fastdds(settings);
    ASSERT_TRUE(bus) << bus.error();
    auto publisher = (*bus)->advertise(topics::frame);
    // RTPS leaves eight ports of each domain free. One address is used for both readers where there are two.
    const std::uint32_t free_port = 7400 + 250 * domain + 2;
    ForeignReader first(domain, free_port, free_port + 2);
    ForeignReader second(domain, free_port + 1, free_port + 2);

    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{20};
    bool by_first = false, by_second = false;
    while (!(by_first && by_second) && std::chrono::steady_clock::now() < deadline) {
        if (publisher.status().matched == 2) publisher.publish(SensorFrame{});
        (*bus)->wait(5'000'000);
        by_first = first.take() || by_first;
        by_second = second.take() || by_second;
    }
    EXPECT_TRUE(by_first && by_second);
}

}  // namespace

}  // namespace quorient::bus
