#include "participant.hpp"

#include "guarded_transport.hpp"
#include "quorient/bus/contract.hpp"
#include "quorient/bus/interfaces.hpp"
#include "quorient/bus/roudi.hpp"
#include "quorient/messages/time.hpp"
#include "security.hpp"

#include <fmt/format.h>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <random>

namespace quorient::bus::fastdds {

namespace {

/// One participant's share, generously: its segment of 512 KiB, its ports, and the ports of its peers.
constexpr std::uintmax_t shared_memory_needed = 4 << 20;

/// Where the participants of an address listen for discovery [RTPS 9.6.1.1]: participant p at 7400 + 250 domain + 10 + 2 p.
void add_peer(const std::string& address, const Settings& settings, wire::LocatorList_t& peers)
{
    for (std::uint32_t participant = 0; participant < settings.participants_per_host; ++participant) {
        wire::Locator_t locator;
        wire::IPLocator::setIPv4(locator, address);
        locator.port = 7400 + 250 * settings.domain + 10 + 2 * participant;
        peers.push_back(locator);
    }
}

constexpr const char* discovery_group = "239.255.0.1";

/// Multicast discovery continues beside the list.
void add_multicast(std::uint32_t domain, wire::LocatorList_t& peers)
{
    wire::Locator_t locator;
    wire::IPLocator::setIPv4(locator, discovery_group);
    locator.port = 7400 + 250 * domain;
    peers.push_back(locator);
}

/// On several networks: the own addresses in a fixed order, because Cyclone DDS 0.10 sends to the first one alone. Fast DDS fills in the
/// participant's ports.
void announce_in_order(dds::WireProtocolConfigQos& wire)
{
    for (const auto& address : own_addresses()) {
        wire::Locator_t locator;
        wire::IPLocator::setIPv4(locator, address);
        wire.builtin.metatrafficUnicastLocatorList.push_back(locator);
        wire.default_unicast_locator_list.push_back(locator);
    }
}

/// The ports in shared memory, other ones in each life of a process. Fast DDS derives them from the domain and the participant's number, so a
/// process that is started again would have those of the one that was killed. Its peers go on sending into the memory of the killed one, until
/// they notice. Where it was killed while it received, they never do (integration_tests/results/kill_matrix.md).
/// UDP's addresses are those that Fast DDS would choose if no list were stated: it fills in the ports, and all addresses of the interface.
void announce_fresh_memory(dds::WireProtocolConfigQos& wire)
{
    constexpr std::uint32_t above_all_udp_ports = 1U << 16;
    std::random_device entropy;
    std::uniform_int_distribution<std::uint32_t> port{above_all_udp_ports, std::numeric_limits<std::int32_t>::max()};
    const std::unique_ptr<rtps::TransportInterface> memory{rtps::SharedMemTransportDescriptor{}.create_transport()};
    if (!memory->init()) return;  // then Fast DDS finds no shared memory either, and must not announce any
    wire::Locator_t multicast;
    wire::IPLocator::setIPv4(multicast, discovery_group);
    wire.builtin.metatrafficMulticastLocatorList.push_back(multicast);
    wire.builtin.metatrafficUnicastLocatorList.push_back(wire::Locator_t{});
    wire.default_unicast_locator_list.push_back(wire::Locator_t{});
    memory->getDefaultMetatrafficUnicastLocators(wire.builtin.metatrafficUnicastLocatorList, port(entropy));
    memory->getDefaultUnicastLocators(wire.default_unicast_locator_list, port(entropy));
}

/// One second, and a little more, different from process to process. Each announcement goes to all ports of all peers, so processes that
/// start together would otherwise all announce at the same moment. In containers process ids are the same.
double announcement_period_s()
{
    std::random_device entropy;
    return std::uniform_real_distribution<double>{1, 1.25}(entropy);
}

/// Linux's default, which must be stated here: behind another transport Fast DDS 2.9.1 reads an unstated size as 0, assumes a full buffer
/// after every sample, and asks each reader to acknowledge it.
constexpr std::uint32_t send_buffer = 212'992;

void add_transports(const Settings& settings, Listening listening, dds::TransportConfigQos& transports)
{
    transports.use_builtin_transports = false;
    const auto udp = std::make_shared<rtps::UDPv4TransportDescriptor>();
    udp->sendBufferSize = send_buffer;
    if (!settings.interface.empty()) udp->interfaceWhiteList = addresses_of(settings.interface);
    transports.user_transports.push_back(guarded(udp, std::move(listening)));
    if (shares_memory(settings)) transports.user_transports.push_back(std::make_shared<rtps::SharedMemTransportDescriptor>());
}

/// Standard output is for what a program prints. By default the library's log would go there as well.
void log_to_stderr()
{
    static std::once_flag once;
    std::call_once(once, [] {
        dds::Log::ClearConsumers();
        dds::Log::RegisterConsumer(std::make_unique<dds::StdoutErrConsumer>());
        dds::Log::SetVerbosity(dds::Log::Error);
    });
}

}  // namespace

Duration seconds(double s)
{
    const auto all_ns = nanoseconds(s);
    return {static_cast<std::int32_t>(all_ns / second_ns), static_cast<std::uint32_t>(all_ns % second_ns)};
}

bool shares_memory(const Settings& settings)
{
    return settings.transport == Transport::shared_memory && settings.shared_memory != SharedMemory::off;
}

tl::expected<Settings, std::string> with_room_in_shared_memory(Settings settings)
{
    if (!shares_memory(settings) || free_shared_memory() >= shared_memory_needed) return settings;
    if (settings.shared_memory == SharedMemory::required)
        return tl::make_unexpected(
            fmt::format("Fast DDS needs {} MiB in /dev/shm, {:.1f} MiB are free: quorient clean removes what killed "
                        "processes left; or use transport udp, or shared_memory: preferred",
                        shared_memory_needed >> 20, static_cast<double>(free_shared_memory()) / (1 << 20)));
    settings.shared_memory = SharedMemory::off;
    return settings;
}

dds::DomainParticipant* join(const Settings& settings, Peers& peers)
{
    log_to_stderr();
    dds::DomainParticipantQos qos;
    qos.name(settings.participant);
    const auto announcement = contract_announcement();
    qos.user_data().data_vec().assign(announcement.begin(), announcement.end());
    if (settings.security) {
        secure(qos.properties(), *settings.security);
        library_refusals();  // reads the log from now on
    }
    const auto listening = std::make_shared<std::atomic<bool>>(false);
    add_transports(settings, listening, qos.transport());
    auto& builtin = qos.wire_protocol().builtin;
    // Peers that start together discover each other without the 3 s announcement. The first one is dropped (guarded_transport.hpp).
    builtin.discovery_config.initial_announcements.count = 50;
    builtin.discovery_config.initial_announcements.period = seconds(0.02);
    builtin.discovery_config.leaseDuration_announcementperiod = seconds(announcement_period_s());
    builtin.discovery_config.leaseDuration = seconds(10);
    if (shares_memory(settings)) announce_fresh_memory(qos.wire_protocol());
    else if (settings.interface.empty() && !settings.peers.empty()) announce_in_order(qos.wire_protocol());
    for (const auto& peer : settings.peers) add_peer(peer, settings, builtin.initialPeersList);
    if (settings.peers.empty()) {
        for (const auto& own : addresses_of(settings.interface)) add_peer(own, settings, builtin.initialPeersList);
        add_multicast(settings.domain, builtin.initialPeersList);
    }

    auto* participant = dds::DomainParticipantFactory::get_instance()->create_participant(settings.domain, qos, &peers, dds::StatusMask::none());
    listening->store(true);
    return participant;
}

}  // namespace quorient::bus::fastdds
