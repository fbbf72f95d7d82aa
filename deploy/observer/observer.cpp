// Prints what a plain subscriber receives: Fast DDS and the wire contract, nothing else of Quorient. `TOPIC {sample}` a line, until it
// receives SIGTERM or SIGINT.   usage: quorient-observer SYSTEM.yaml
#include <yaml-cpp/yaml.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "fastdds_version.hpp"
#include "quorient_msgsPubSubTypes.hpp"

using namespace eprosima::fastdds::dds;
using Json = nlohmann::ordered_json;

namespace {

volatile std::sig_atomic_t stop = 0;

void on_signal(int)
{
    stop = 1;
}

double steady_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Options {
    unsigned domain;
    double lease_s;  ///< lease of `voted`: a reader must not request less than the voters offer
    std::vector<std::string> peers;
    std::uint32_t participants_per_host;
};

Options read(const char* file)
{
    const auto system = YAML::LoadFile(file);
    const double shortest_s = std::max(0.05, 3 / system["source"]["rate_hz"].as<double>());
    const auto voting = system["voting"];
    return {system["domain"].as<unsigned>(),
            voting && voting["lease_s"] ? std::max(shortest_s, voting["lease_s"].as<double>()) : shortest_s,
            system["peers"].as<std::vector<std::string>>(), system["participants_per_host"].as<std::uint32_t>()};
}

/// A peer on Cyclone DDS 0.10 sends to the first address that we announce, and the kernel's own order of two networks is not always the
/// same.
void announce_in_order(WireProtocolConfigQos& wire)
{
    using namespace fastdds_version::rtps;
    std::vector<IPFinder::info_IP> found;
    IPFinder::getIPs(&found, false);
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.locator < b.locator; });
    for (auto& own : found) {
        if (own.type != IPFinder::IP4) continue;
        own.locator.port = 0;  // filled in by Fast DDS
        wire.builtin.metatrafficUnicastLocatorList.push_back(own.locator);
        wire.default_unicast_locator_list.push_back(own.locator);
    }
}

/// Fast DDS 2.9.1 must know every address from the start.
DomainParticipantQos participant_qos(const Options& options)
{
    DomainParticipantQos qos;
    qos.name("observer");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>());
    auto& builtin = qos.wire_protocol().builtin;
    builtin.discovery_config.initial_announcements.count = 50;
    builtin.discovery_config.initial_announcements.period = {0, 100'000'000};
    builtin.discovery_config.leaseDuration_announcementperiod = {1, 0};
    announce_in_order(qos.wire_protocol());
    for (const auto& peer : options.peers) {
        for (std::uint32_t port = 10; port < 10 + 2 * options.participants_per_host; ++port) {
            fastdds_version::rtps::Locator_t locator;
            fastdds_version::rtps::IPLocator::setIPv4(locator, peer);
            locator.port = 7400 + 250 * options.domain + port;
            builtin.initialPeersList.push_back(locator);
        }
    }
    return qos;
}

template <class Voted>
Json voted_json(const Voted& voted)
{
    return {{"epoch", voted.epoch()},
            {"sequence_number", voted.sequence_number()},
            {"output_sequence", voted.output_sequence()},
            {"attitude", voted.attitude()},
            {"angle_sigma_rad", voted.angle_sigma_rad()},
            {"reset_counter", voted.reset_counter()},
            {"voter", voted.voter()},
            {"primary_lane", voted.primary_lane()},
            {"vouching_mask", voted.vouching_mask()},
            {"excluded_mask", voted.excluded_mask()},
            {"isolated_mask", voted.isolated_mask()},
            {"mode", voted.mode()},
            {"level", voted.level()}};
}

Json json_of(const quorient_msgs::VotedAttitude& voted)
{
    return voted_json(voted);
}

Json json_of(const quorient_msgs::VoterOutput& voted)
{
    return voted_json(voted);
}

Json json_of(const quorient_msgs::TruthState& truth)
{
    return {{"epoch", truth.epoch()},
            {"sequence_number", truth.sequence_number()},
            {"attitude", truth.attitude()},
            {"faulty_mask", truth.faulty_mask()}};
}

Json json_of(const quorient_msgs::HealthEvent& event)
{
    return {{"source_name", event.source_name().data()},
            {"epoch", event.epoch()},
            {"sequence_number", event.sequence_number()},
            {"code", event.code()},
            {"severity", event.severity()},
            {"text", event.text().data()}};
}

Json json_of(const quorient_msgs::ServiceStatus& status)
{
    return {{"name", status.name().data()}, {"state", status.state()}, {"vendor", status.vendor()}, {"transport", status.transport()}};
}

class Observer {
public:
    explicit Observer(const Options& options)
        : participant_{DomainParticipantFactory::get_instance()->create_participant(options.domain, participant_qos(options))}
    {
        if (participant_) subscriber_ = participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
    }

    ~Observer()
    {
        if (!participant_) return;
        participant_->delete_contained_entities();
        DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }

    Observer(const Observer&) = delete;
    Observer& operator=(const Observer&) = delete;

    /// @returns false where Fast DDS refuses.
    template <class Sample, class Support>
    bool watch(const std::string& name, const DataReaderQos& qos)
    {
        if (!subscriber_) return false;
        TypeSupport type{new Support};
        type.register_type(participant_);
        auto* topic = participant_->create_topic("quorient/" + name, type.get_type_name(), TOPIC_QOS_DEFAULT);
        auto* reader = topic ? subscriber_->create_datareader(topic, qos) : nullptr;
        if (!reader) return false;
        reader->get_statuscondition().set_enabled_statuses(StatusMask::data_available());
        waitset_.attach_condition(reader->get_statuscondition());
        takers_.push_back([reader, name, sample = std::make_shared<Sample>()] {
            SampleInfo info;
            while (fastdds_version::is_ok(reader->take_next_sample(sample.get(), &info))) {
                if (!info.valid_data) continue;  // a writer left
                auto json = json_of(*sample);
                json["arrival_s"] = steady_s();
                std::printf("%s %s\n", name.c_str(), json.dump().c_str());
            }
        });
        return true;
    }

    void run()
    {
        while (!stop) {
            ConditionSeq triggered;
            waitset_.wait(triggered, fastdds_version::Duration{0, 100'000'000});
            for (const auto& take : takers_) take();
            std::fflush(stdout);
        }
    }

private:
    DomainParticipant* participant_;
    Subscriber* subscriber_ = nullptr;
    WaitSet waitset_;
    std::vector<std::function<void()>> takers_;
};

DataReaderQos reliable(int depth)
{
    DataReaderQos qos;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.history().depth = depth;
    return qos;
}

/// DDS delivers the samples of the voter that owns `voted`, and those of the next one once the owner's lease has run out.
DataReaderQos owned(double lease_s)
{
    auto qos = reliable(64);
    qos.ownership().kind = EXCLUSIVE_OWNERSHIP_QOS;
    qos.liveliness().kind = MANUAL_BY_TOPIC_LIVELINESS_QOS;
    constexpr double ns = 1e9;  // Duration_t's own conversion rounds down, and a shorter lease than the voters' matches none of them
    const auto lease_ns = std::llround(lease_s * ns);
    qos.liveliness().lease_duration = {static_cast<std::int32_t>(lease_ns / 1'000'000'000),
                                       static_cast<std::uint32_t>(lease_ns % 1'000'000'000)};
    return qos;
}

DataReaderQos latched(int depth)
{
    auto qos = reliable(depth);
    qos.durability().kind = TRANSIENT_LOCAL_DURABILITY_QOS;
    return qos;
}

/// Says when this machine let a thread that only sleeps wait: what is late then is not the pipeline's fault alone.
void witness()
{
    constexpr double nap_s = 0.005;
    constexpr double late_s = 0.01;
    while (!stop) {
        const double begin_s = steady_s();
        std::this_thread::sleep_for(std::chrono::duration<double>(nap_s));
        const double end_s = steady_s();
        if (end_s - begin_s > nap_s + late_s) std::printf("stall %s\n", Json{{"begin_s", begin_s}, {"end_s", end_s}}.dump().c_str());
    }
}

int observe(const Options& options)
{
    using namespace quorient_msgs;
    Observer observer{options};
    DataReaderQos best_effort;
    best_effort.history().depth = 8;
    const bool good = observer.watch<VotedAttitude, VotedAttitudePubSubType>("voted", owned(options.lease_s)) &&
                      observer.watch<VoterOutput, VoterOutputPubSubType>("voter_output", reliable(64)) &&
                      observer.watch<TruthState, TruthStatePubSubType>("truth", reliable(64)) &&
                      observer.watch<HealthEvent, HealthEventPubSubType>("event", latched(256)) &&
                      observer.watch<ServiceStatus, ServiceStatusPubSubType>("status", best_effort);
    if (!good) return std::fprintf(stderr, "cannot join domain %u\n", options.domain), 1;
    std::thread watchman{witness};
    observer.run();
    watchman.join();
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2 || std::string{argv[1]} == "--help")
        return std::fprintf(stderr, "usage: quorient-observer SYSTEM.yaml   (its domain, rate_hz and peers)\n"), argc == 2 ? 0 : 2;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    try {
        return observe(read(argv[1]));
    } catch (const YAML::Exception& problem) {
        return std::fprintf(stderr, "%s: %s\n", argv[1], problem.what()), 2;
    }
}
