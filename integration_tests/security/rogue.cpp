// An attacker: publishes forged samples on the given topics, subscribes to all topics, and prints the counts as JSON.

#include "layout.hpp"
#include "patched.hpp"
#include "quorient/bus/bus.hpp"
#include "quorient/messages/codes.hpp"

#include <dds/dds.h>
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <dlfcn.h>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

bool rogue::patched = false;
long rogue::clock_offset_s = 0;

/// A program's symbols take precedence over the C library's: OpenSSL calls this one.
extern "C" std::time_t time(std::time_t* result) noexcept
{
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    const std::time_t shifted = now.tv_sec + rogue::clock_offset_s;
    if (result) *result = shifted;
    return shifted;
}

std::string rogue::patched_plugin()
{
    return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "libquorient_patched_cyclonedds.so";
}

/// Replaces the access-control plug-in between the bus and Cyclone DDS (linked with --wrap).
extern "C" void __real_dds_qset_prop(dds_qos_t* qos, const char* name, const char* value);
extern "C" void __wrap_dds_qset_prop(dds_qos_t* qos, const char* name, const char* value)
{
    if (!rogue::patched || std::string{name} != "dds.sec.access.library.path") return __real_dds_qset_prop(qos, name, value);
    ::setenv("ROGUE_ACCESS_CONTROL", value, 1);
    __real_dds_qset_prop(qos, name, rogue::patched_plugin().c_str());
}

namespace {

using namespace quorient;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

struct Options {
    std::string dds = "cyclonedds";
    std::uint32_t domain = 42;
    double seconds = 3;
    std::string keys, name;
    std::vector<std::string> publish;
    bool report = false;
};

constexpr std::uint32_t unit = 1;

/// Marks a forged sample, one value for each vendor that wrote it.
constexpr std::uint32_t mark_of_fastdds = 99;
constexpr std::uint32_t mark_of_cyclonedds = 98;

std::uint64_t wall_ns()
{
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count());
}

/// The member that carries the mark; no sample of the system has such a value there.
std::uint32_t& mark_in(SensorFrame& frame) { return frame.description_revision; }
std::uint32_t& mark_in(FaultVerdict& verdict) { return verdict.detector; }
std::uint32_t& mark_in(FaultDiagnosis& diagnosis) { return diagnosis.detector; }
std::uint32_t& mark_in(AttitudeState& attitude) { return attitude.lane; }
std::uint32_t& mark_in(VotedAttitude& voted) { return voted.voter; }
std::uint32_t& mark_in(FaultCommand& order) { return order.axes; }
std::uint32_t& mark_in(ClusterDescription& description) { return description.revision; }
std::uint32_t& mark_in(TruthState& truth) { return truth.faulty_mask; }
std::uint32_t& mark_in(HealthEvent& event) { return event.source; }
std::uint32_t& mark_in(ServiceStatus& status) { return status.service; }

/// A forged sample for the unit, newer than all true ones.
template <class Message>
Message forged(std::uint64_t sequence)
{
    Message message;
    message.unit = unit;
    if constexpr (requires { message.epoch; }) message.epoch = wall_ns();
    if constexpr (requires { message.sequence; }) message.sequence = sequence;
    if constexpr (requires { message.output_sequence; }) message.output_sequence = sequence;
    if constexpr (std::is_same_v<Message, FaultCommand>) {
        message.request = wall_ns();
        message.action = static_cast<std::uint8_t>(1 + sequence % 4);  // orders of every kind, in turn
        message.kind = static_cast<std::uint8_t>(FaultKind::zero);
        message.end_s = 1;
    }
    return message;
}

class Rogue {
public:
    explicit Rogue(const Options& options) : options_(options) {}

    Json run()
    {
        auto opened = bus::open(settings());
        if (!opened) return {{"joined", false}, {"why", opened.error()}};
        bus_ = std::move(*opened);
        std::apply([&](const auto&... topic) { (subscribe(topic), ...); }, bus::topics::all);
        std::apply([&](const auto&... topic) { (publish(topic), ...); }, bus::topics::all);
        const auto end = Clock::now() + std::chrono::duration<double>{options_.seconds};
        auto next_report = Clock::now();
        while (Clock::now() < end) {
            for (const auto& send : publications_) send();
            bus_->wait(20'000'000);
            for (const auto& take : subscriptions_) take();
            if (!options_.report || Clock::now() < next_report) continue;
            next_report += std::chrono::milliseconds{100};
            std::cout << result().dump() << std::endl;
        }
        return result();
    }

private:
    bus::Settings settings() const
    {
        bus::Settings settings;
        settings.vendor = *bus::vendor_from(options_.dds);
        settings.domain = options_.domain;
        settings.participant = options_.name.empty() ? "rogue" : options_.name;
        if (options_.keys.empty()) return settings;
        const security::Layout keys{std::filesystem::absolute(options_.keys)};
        const auto& name = options_.name;
        settings.security = {"", keys.identity_ca(), keys.certificate(name, settings.vendor), keys.key(name), keys.permissions_ca(),
                             keys.governance(), keys.permissions(name), keys.revoked()};
        return settings;
    }

    template <class Message>
    void subscribe(const bus::Topic<Message>& topic)
    {
        const std::string name = topic.spec.name;
        try {
            auto subscription = std::make_shared<bus::Subscription<Message>>(bus_->subscribe(topic));
            received_[name] = 0;
            subscriptions_.push_back([this, subscription, name] {
                Message message;
                while (subscription->take(message)) {
                    const auto mark = mark_in(message);
                    if constexpr (std::is_same_v<Message, SensorFrame>) count_repeated(message);
                    if (mark == mark_of_fastdds || mark == mark_of_cyclonedds) ++forged_[std::to_string(mark)];
                    else ++received_[name];
                    if constexpr (std::is_same_v<Message, VotedAttitude>) ++of_voter_[std::to_string(message.voter)];
                }
            });
        } catch (const bus::Error&) {
            refused_.push_back("subscribe " + name);
        }
    }

    template <class Message>
    void publish(const bus::Topic<Message>& topic)
    {
        const std::string name = topic.spec.name;
        if (std::ranges::find(options_.publish, name.substr(name.find('/') + 1)) == options_.publish.end()) return;
        try {
            auto publisher = std::make_shared<bus::Publisher<Message>>(bus_->advertise(topic, {.strength = 1000, .lease_s = 0.05}));
            publications_.push_back([this, publisher, name] {
                matched_[name] = std::max(matched_[name], publisher->status().matched);
                auto message = forged<Message>(sent_[name]++);
                mark_in(message) = bus_->vendor() == Vendor::fastdds ? mark_of_fastdds : mark_of_cyclonedds;
                publisher->publish(message);
            });
        } catch (const bus::Error&) {
            refused_.push_back("publish " + name);
        }
    }

    /// One sensor publishes frames, each once and in order.
    void count_repeated(const SensorFrame& frame)
    {
        const std::pair identity{frame.epoch, frame.sequence};
        if (identity <= newest_) ++repeated_;
        else newest_ = identity;
    }

    Json result() const
    {
        std::uint64_t received = 0, sent = 0;
        for (const auto& [topic, count] : received_) received += count;
        for (const auto& [topic, count] : sent_) sent += count;
        return {{"joined", true}, {"received", received},  {"of_voter", of_voter_},       {"forged", forged_},
                {"sent", sent}, {"repeated", repeated_}, {"matched", matched_}, {"refused_locally", refused_}};
    }

    Options options_;
    std::unique_ptr<bus::Bus> bus_;
    std::vector<std::function<void()>> publications_, subscriptions_;
    std::map<std::string, std::uint64_t> received_, sent_, of_voter_, forged_;
    std::map<std::string, std::uint32_t> matched_;
    std::vector<std::string> refused_;
    std::pair<std::uint64_t, std::uint64_t> newest_{};
    std::uint64_t repeated_ = 0;
};

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{"An attacker on the bus"};
    Options options;
    app.add_option("--dds", options.dds);
    app.add_option("--domain", options.domain);
    app.add_option("--seconds", options.seconds);
    app.add_option("--keys", options.keys, "Directory of keys; default: no certificate");
    app.add_option("--as", options.name, "Identity to use");
    app.add_option("--publish", options.publish, "Topics to forge, e.g. frame")->delimiter(',');
    app.add_flag("--report", options.report, "Print the counts ten times a second");
    app.add_flag("--patched", rogue::patched, "Skip the check of its own permissions");
    app.add_option("--clock", rogue::clock_offset_s, "Seconds added to its clock");
    CLI11_PARSE(app, argc, argv);
    std::cout << Rogue{options}.run().dump() << std::endl;
    return 0;
}
