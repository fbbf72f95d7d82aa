// Publishes a random message on every topic, or receives the same messages and compares them field by field. Either end may be of another
// release of Debian; every_topic.py starts both.

#include "../../common/bus/test/random_message.hpp"
#include "quorient/bus/bus.hpp"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace quorient;
using Clock = std::chrono::steady_clock;

struct Options {
    std::string vendor;
    std::uint32_t domain = 0;
    std::uint64_t seed = 0;
    double seconds = 0;
    bool writes = false;
};

constexpr std::int64_t period_ns = 20'000'000;

/// Calls `work` once in a period, until it returns true or the time is over. @returns whether it did
template <class Work>
bool repeat(bus::Bus& bus, double seconds, Work work)
{
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    while (Clock::now() < end) {
        if (work()) return true;
        bus.wait(period_ns);
    }
    return false;
}

int write_all(bus::Bus& bus, const Options& options)
{
    std::vector<std::function<void()>> publications;
    const auto advertise = [&]<class Message>(const bus::Topic<Message>& topic) {
        auto publisher = std::make_shared<bus::Publisher<Message>>(bus.advertise(topic));
        publications.push_back([publisher, message = bus::message_for(topic, options.seed)] { publisher->publish(message); });
    };
    std::apply([&](const auto&... topic) { (advertise(topic), ...); }, bus::topics::all);
    repeat(bus, options.seconds, [&] {
        for (const auto& publish : publications) publish();
        return false;
    });
    return 0;
}

/// @returns the names of the fields that differ
template <class Message>
std::string differences(const Message& expected, const Message& received)
{
    std::string names;
    std::apply(
        [&](const auto&... field) {
            ((expected.*(field.member) == received.*(field.member) ? void() : void(names += std::string{" "} + field.name)), ...);
        },
        Fields<Message>::all);
    return names;
}

int read_all(bus::Bus& bus, const Options& options)
{
    std::set<std::string> missing;
    std::string different;
    std::vector<std::function<void()>> takes;
    const auto subscribe = [&]<class Message>(const bus::Topic<Message>& topic) {
        auto subscription = std::make_shared<bus::Subscription<Message>>(bus.subscribe(topic));
        const std::string name{topic.spec.name};
        missing.insert(name);
        takes.push_back([&missing, &different, subscription, name, expected = bus::message_for(topic, options.seed)] {
            Message message;
            while (subscription->take(message)) {
                if (const auto names = differences(expected, message); !names.empty()) different += name + ":" + names + "; ";
                missing.erase(name);
            }
        });
    };
    std::apply([&](const auto&... topic) { (subscribe(topic), ...); }, bus::topics::all);
    const auto begin = Clock::now();
    const bool complete = repeat(bus, options.seconds, [&] {
        for (const auto& take : takes) take();
        return missing.empty();
    });
    std::string absent;
    for (const auto& name : missing) absent += name + " ";
    std::printf("%zu of %zu topics in %.1f s; missing: %s; different: %s\n", takes.size() - missing.size(), takes.size(),
                std::chrono::duration<double>(Clock::now() - begin).count(), absent.empty() ? "none" : absent.c_str(),
                different.empty() ? "none" : different.c_str());
    return complete && different.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Publishes a random message on every topic, or receives and compares them."};
    Options options;
    app.add_option("vendor", options.vendor, "fastdds or cyclonedds")->required();
    app.add_option("domain", options.domain)->required();
    app.add_option("seed", options.seed, "the same at both ends")->required();
    app.add_option("seconds", options.seconds, "how long at most")->required();
    app.add_flag("--write", options.writes);
    CLI11_PARSE(app, argc, argv);
    const auto vendor = bus::vendor_from(options.vendor);
    if (!vendor) {
        std::fprintf(stderr, "no vendor '%s': fastdds or cyclonedds\n", options.vendor.c_str());
        return 2;
    }
    bus::Settings settings;
    settings.vendor = *vendor;
    settings.domain = options.domain;
    settings.participant = options.writes ? "writer" : "reader";
    auto bus = bus::open(settings);
    if (!bus) {
        std::fprintf(stderr, "%s\n", bus.error().c_str());
        return 2;
    }
    return options.writes ? write_all(**bus, options) : read_all(**bus, options);
}
