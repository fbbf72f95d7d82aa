// Round trips of one sample between two processes, four ways in turns of a few: our bus, the vendor's API, a futex, a UDP socket.

#include "quantiles.hpp"
#include "quorient/bus/bus.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "raw.hpp"

#include <arpa/inet.h>
#include <linux/futex.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <iostream>
#include <string>
#include <thread>

namespace {

using namespace quorient;

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr bus::Topic<SensorFrame> ping_topic{"latency/ping", bus::TypeId::sensor_frame, {}};
constexpr bus::Topic<SensorFrame> pong_topic{"latency/pong", bus::TypeId::sensor_frame, {}};

std::int64_t now_ns()
{
    return std::chrono::steady_clock::now().time_since_epoch().count();
}

/// One way there and back; an answer that does not come within 0.1 s is lost.
class Path {
public:
    virtual ~Path() = default;
    virtual void send(const SensorFrame& frame) = 0;
    /// Blocks for a sample, at most 0.1 s.
    virtual bool receive(SensorFrame& frame) = 0;
    virtual bool connected() { return true; }
};

constexpr std::int64_t patience_ns = second_ns / 10;

template <class Take, class Wait>
bool receive_within_patience(Take take, Wait wait)
{
    const auto deadline = now_ns() + patience_ns;
    while (!take()) {
        const auto left = deadline - now_ns();
        if (left <= 0) return false;
        wait(left);
    }
    return true;
}

/// Whether a path spins now in place of blocking.
using Spins = std::function<bool()>;

class BusPath final : public Path {
public:
    BusPath(const bus::Settings& settings, bool first, Spins spins)
        : spins_(std::move(spins)),
          bus_(open(settings)),
          out_(bus_->advertise(first ? ping_topic : pong_topic)),
          in_(bus_->subscribe(first ? pong_topic : ping_topic))
    {
    }

    void send(const SensorFrame& frame) override { out_.publish(frame); }
    bool receive(SensorFrame& frame) override
    {
        return receive_within_patience([&] { return in_.take(frame); },
                                       [&](std::int64_t left) {
                                           if (!spins_()) bus_->wait(left);
                                       });
    }
    bool connected() override { return out_.status().matched > 0 && in_.status().matched > 0; }

private:
    static std::unique_ptr<bus::Bus> open(const bus::Settings& settings)
    {
        auto bus = bus::open(settings);
        if (!bus) throw std::runtime_error(bus.error());
        return std::move(*bus);
    }

    Spins spins_;
    std::unique_ptr<bus::Bus> bus_;
    bus::Publisher<SensorFrame> out_;
    bus::Subscription<SensorFrame> in_;
};

class RawPath final : public Path {
public:
    RawPath(Vendor vendor, const latency::RawSettings& settings, bool first, Spins spins)
        : spins_(std::move(spins)),
          raw_(vendor == Vendor::fastdds ? latency::open_raw_fastdds(settings) : latency::open_raw_cyclonedds(settings)),
          out_(raw_->writer(latency::Type::frame, (first ? ping_topic : pong_topic).spec.name)),
          in_(raw_->reader(latency::Type::frame, (first ? pong_topic : ping_topic).spec.name))
    {
    }

    void send(const SensorFrame& frame) override { out_->write(&frame); }
    bool receive(SensorFrame& frame) override
    {
        return receive_within_patience([&] { return in_->take(&frame); },
                                       [&](std::int64_t left) {
                                           if (!spins_()) raw_->wait(left);
                                       });
    }
    bool connected() override { return out_->matched() > 0 && in_->matched() > 0; }

private:
    Spins spins_;
    std::unique_ptr<latency::Raw> raw_;
    std::unique_ptr<latency::RawWriter> out_;
    std::unique_ptr<latency::RawReader> in_;
};

/// Two slots in memory that both processes share, each with its word to sleep on, and whose turn it is.
struct Shared {
    std::atomic<std::size_t> turn;
    std::atomic<std::uint32_t> count[2];
    SensorFrame frame[2];
};

class FutexPath final : public Path {
public:
    FutexPath(Shared& shared, bool first) : shared_(shared), out_(first ? 0 : 1), in_(first ? 1 : 0) {}

    void send(const SensorFrame& frame) override
    {
        shared_.frame[out_] = frame;
        shared_.count[out_].fetch_add(1, std::memory_order_release);
        ::syscall(SYS_futex, &shared_.count[out_], FUTEX_WAKE, 1, nullptr, nullptr, 0);
    }
    bool receive(SensorFrame& frame) override
    {
        const auto deadline = now_ns() + patience_ns;
        while (shared_.count[in_].load(std::memory_order_acquire) == taken_) {
            const auto left = deadline - now_ns();
            if (left <= 0) return false;
            const timespec timeout{0, left};
            ::syscall(SYS_futex, &shared_.count[in_], FUTEX_WAIT, taken_, &timeout, nullptr, 0);
        }
        ++taken_;
        frame = shared_.frame[in_];
        return true;
    }

private:
    Shared& shared_;
    int out_;
    int in_;
    std::uint32_t taken_ = 0;
};

class UdpPath final : public Path {
public:
    UdpPath(int own, const sockaddr_in& peer) : socket_(own), peer_(peer)
    {
        const timeval timeout{0, patience_ns / 1000};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
    }

    void send(const SensorFrame& frame) override
    {
        ::sendto(socket_, &frame, sizeof frame, 0, reinterpret_cast<const sockaddr*>(&peer_), sizeof peer_);
    }
    bool receive(SensorFrame& frame) override { return ::recv(socket_, &frame, sizeof frame, 0) == sizeof frame; }

private:
    int socket_;
    sockaddr_in peer_;
};

struct Options {
    std::string dds = "cyclonedds";
    std::string transport = "udp";
    std::uint32_t domain = 30;
    double rate_hz = 1000;
    int rounds = 5;
    int per_round = 400;  ///< for each path
    int turn = 20;        ///< round trips of one path before the next has its turn
    bool spin = false;    ///< the paths by DDS
};

/// What both processes hold from before they part.
struct Common {
    Shared* shared;
    int sockets[2];
    sockaddr_in addresses[2];
};

Common make_common()
{
    Common common{};
    common.shared = static_cast<Shared*>(::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    for (int i = 0; i < 2; ++i) {
        common.sockets[i] = ::socket(AF_INET, SOCK_DGRAM, 0);
        common.addresses[i].sin_family = AF_INET;
        common.addresses[i].sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        ::bind(common.sockets[i], reinterpret_cast<const sockaddr*>(&common.addresses[i]), sizeof(sockaddr_in));
        socklen_t length = sizeof(sockaddr_in);
        ::getsockname(common.sockets[i], reinterpret_cast<sockaddr*>(&common.addresses[i]), &length);
    }
    return common;
}

struct NamedPath {
    const char* name;
    std::unique_ptr<Path> path;
};

std::vector<NamedPath> make_paths(const Options& options, const Common& common, bool first)
{
    bus::Settings settings;
    settings.vendor = bus::vendor_from(options.dds).value();
    settings.transport = bus::transport_from(options.transport).value();
    settings.domain = options.domain;
    settings.heartbeat_s = 0.5 / options.rate_hz;
    std::vector<NamedPath> paths;
    const auto spins = [&options, &turn = common.shared->turn](std::size_t path) {
        return [spin = options.spin, &turn, path] { return spin && turn.load(std::memory_order_relaxed) == path; };
    };
    paths.push_back({"bus", std::make_unique<BusPath>(settings, first, spins(0))});
    // Another domain: another set of sockets, the same process.
    paths.push_back(
        {"vendor", std::make_unique<RawPath>(
                       settings.vendor, latency::RawSettings{options.domain + 1, settings.transport != Transport::udp}, first, spins(1))});
    paths.push_back({"futex", std::make_unique<FutexPath>(*common.shared, first)});
    paths.push_back({"udp socket", std::make_unique<UdpPath>(common.sockets[first ? 0 : 1], common.addresses[first ? 1 : 0])});
    return paths;
}

/// Answers on every path, each on a thread of its own that sleeps while the others have their turn. Ends with its parent.
[[noreturn]] void answer(const Options& options, const Common& common)
{
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    auto paths = make_paths(options, common, false);
    std::vector<std::jthread> threads;
    for (auto& named : paths) {
        threads.emplace_back([&path = *named.path] {
            SensorFrame frame;
            for (;;) {
                if (path.receive(frame)) path.send(frame);
            }
        });
    }
    for (auto& thread : threads) thread.join();
    ::_exit(0);
}

struct Tally {
    std::vector<std::int64_t> one_way_ns;
    int lost = 0;
};

void trip(Path& path, std::uint64_t sequence, Tally& tally)
{
    SensorFrame sent;
    SensorFrame received;
    sent.sequence = sequence;
    const auto begin = now_ns();
    path.send(sent);
    bool answered = path.receive(received);
    while (answered && received.sequence != sequence) answered = path.receive(received);  // one that was given up before
    if (answered) tally.one_way_ns.push_back((now_ns() - begin) / 2);
    else ++tally.lost;
}

nlohmann::json measure(const Options& options, Shared& shared, std::vector<NamedPath>& paths)
{
    const auto deadline = now_ns() + 10 * second_ns;
    for (auto& named : paths) {
        while (!named.path->connected()) {
            if (now_ns() > deadline) throw std::runtime_error(std::string{named.name} + ": the other process did not match within 10 s");
            std::this_thread::sleep_for(std::chrono::milliseconds{10});
        }
    }
    const std::chrono::nanoseconds interval{static_cast<std::int64_t>(static_cast<double>(second_ns) / options.rate_hz)};
    std::uint64_t sequence = 0;
    nlohmann::json rounds = nlohmann::json::array();
    for (int round = -1; round < options.rounds; ++round) {  // the first warms up
        std::vector<Tally> tallies(paths.size());
        auto due = std::chrono::steady_clock::now();
        for (int turn = 0; turn < (round < 0 ? 3 : options.per_round / options.turn); ++turn) {
            for (std::size_t place = 0; place < paths.size(); ++place) {
                // Forwards and backwards: the order (and with it which path finds the vendor's code in the cache) changes from turn to
                // turn.
                const auto i = turn % 2 == 0 ? place : paths.size() - 1 - place;
                shared.turn = i;
                for (int k = 0; k < options.turn; ++k) {
                    std::this_thread::sleep_until(due);
                    trip(*paths[i].path, ++sequence, tallies[i]);
                    due = std::max(due + interval, std::chrono::steady_clock::now());
                }
            }
        }
        if (round < 0) continue;
        nlohmann::json entry;
        for (std::size_t i = 0; i < paths.size(); ++i) {
            entry[paths[i].name] = latency::quantiles_us(std::move(tallies[i].one_way_ns));
            entry[paths[i].name]["lost"] = tallies[i].lost;
        }
        rounds.push_back(entry);
    }
    return {{"dds", options.dds},   {"transport", options.transport}, {"rate_hz", options.rate_hz},
            {"spin", options.spin}, {"bytes", sizeof(SensorFrame)},   {"rounds", rounds}};
}

int run(const Options& options)
{
    const auto common = make_common();
    const auto child = ::fork();
    if (child == 0) answer(options, common);
    auto paths = make_paths(options, common, true);
    std::cout << measure(options, *common.shared, paths) << std::endl;
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App program{"Half round trips between two processes by our bus, the vendor's API, a futex and a UDP socket, in turns."};
    Options options;
    program.add_option("--dds", options.dds)->check(CLI::IsMember({"fastdds", "cyclonedds"}));
    program.add_option("--transport", options.transport)->check(CLI::IsMember({"udp", "shm", "iceoryx"}));
    program.add_option("--domain", options.domain, "This one and the next");
    program.add_option("--rate", options.rate_hz)->type_name("HZ");
    program.add_flag("--spin", options.spin, "The paths by DDS, while it is their turn");
    program.add_option("--rounds", options.rounds);
    program.add_option("--per-round", options.per_round);
    CLI11_PARSE(program, argc, argv);
    try {
        return run(options);
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
