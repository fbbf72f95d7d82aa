// The other process of the secured pairs: publishes every topic until it is ended.
// usage: security_peer KEYS VENDOR DOMAIN LEVEL SEED

#include "../../bus/test/random_message.hpp"
#include "exchange.hpp"

#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <vector>

namespace {

using namespace quorient;

std::atomic<bool> ended{false};

void publish_all(bus::Bus& bus, std::uint64_t seed)
{
    std::vector<std::function<void()>> publications;
    const auto advertise = [&](const auto& topic) {
        using Message = typename std::decay_t<decltype(topic)>::Message;
        auto publisher = std::make_shared<bus::Publisher<Message>>(bus.advertise(topic));
        publications.push_back([publisher, message = bus::message_for(topic, seed)] { publisher->publish(message); });
    };
    std::apply([&](const auto&... topic) { (advertise(topic), ...); }, bus::topics::all);
    std::puts("here");
    std::fflush(stdout);
    constexpr std::int64_t period_ns = 20'000'000;
    while (!ended) {
        for (const auto& publish : publications) publish();
        bus.wait(period_ns);
    }
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 6) return 2;
    std::signal(SIGTERM, [](int) { ended = true; });
    try {
        const auto bus = security::join(argv[1], "writer", *bus::vendor_from(argv[2]), static_cast<std::uint32_t>(std::stoul(argv[3])),
                                        *bus::security_level_from(argv[4]));
        publish_all(*bus, std::stoull(argv[5]));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
