// What a frame's way through all services allocates on the service thread: our code nothing, the vendor's counted apart and printed.

#include "attitude_integrator.hpp"
#include "parity_fdi.hpp"
#include "quorient/bus/bus.hpp"
#include "sensor_publisher.hpp"
#include "voter.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <utility>

// NOLINTBEGIN: the C library's own names, so that its every caller in this process is counted
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
}
// NOLINTEND

namespace {

enum class Where { elsewhere, our_code, vendor_call };

thread_local Where where = Where::elsewhere;
std::atomic<std::uint64_t> ours{0};
std::atomic<std::uint64_t> in_vendor_calls{0};
std::atomic<std::uint64_t> on_vendor_threads{0};

void count()
{
    switch (where) {
        case Where::our_code:
            ours.fetch_add(1, std::memory_order_relaxed);
            break;
        case Where::vendor_call:
            in_vendor_calls.fetch_add(1, std::memory_order_relaxed);
            break;
        case Where::elsewhere:
            on_vendor_threads.fetch_add(1, std::memory_order_relaxed);
            break;
    }
}

/// Marks a stretch of this thread.
class At {
public:
    explicit At(Where here) : before_(std::exchange(where, here)) {}
    ~At() { where = before_; }
    At(const At&) = delete;
    At& operator=(const At&) = delete;

private:
    Where before_;
};

}  // namespace

extern "C" void* malloc(std::size_t size)
{
    count();
    return __libc_malloc(size);
}
extern "C" void* calloc(std::size_t number, std::size_t size)
{
    count();
    return __libc_calloc(number, size);
}
extern "C" void* realloc(void* memory, std::size_t size)
{
    count();
    return __libc_realloc(memory, size);
}

namespace quorient {

namespace {

template <class Message>
class MarkedWriter final : public bus::Writer {
public:
    explicit MarkedWriter(bus::Publisher<Message> publisher) : publisher_(std::move(publisher)) {}

    bool write(const void* message) override
    {
        const At here{Where::vendor_call};
        return publisher_.publish(*static_cast<const Message*>(message));
    }
    void assert_liveliness() override
    {
        const At here{Where::vendor_call};
        publisher_.assert_liveliness();
    }
    bus::EndpointStatus status() override
    {
        const At here{Where::vendor_call};
        return publisher_.status();
    }

private:
    bus::Publisher<Message> publisher_;
};

template <class Message>
class MarkedReader final : public bus::Reader {
public:
    explicit MarkedReader(bus::Subscription<Message> subscription) : subscription_(std::move(subscription)) {}

    bool take(void* message) override
    {
        const At here{Where::vendor_call};
        return subscription_.take(*static_cast<Message*>(message));
    }
    bus::EndpointStatus status() override
    {
        const At here{Where::vendor_call};
        return subscription_.status();
    }

private:
    bus::Subscription<Message> subscription_;
};

/// A vendor's bus whose calls are told from our code. The bus room's own few lines (a copy of the sample) count as the vendor's.
class MarkedBus final : public bus::Bus {
public:
    explicit MarkedBus(bus::Bus& bus) : bus_(bus) {}

    void wait(std::int64_t timeout_ns) override
    {
        const At here{Where::vendor_call};
        bus_.wait(timeout_ns);
    }
    Vendor vendor() const override { return bus_.vendor(); }

private:
    template <class Made>
    std::unique_ptr<Made> with_type_of(const bus::TopicSpec& spec, auto make)
    {
        std::unique_ptr<Made> made;
        std::apply([&](const auto&... topic) { ((spec.type == topic.spec.type ? void(made = make(topic)) : void()), ...); },
                   bus::topics::all);
        return made;
    }

    std::unique_ptr<bus::Writer> make_writer(const bus::TopicSpec& spec, const bus::WriterOptions& options) override
    {
        return with_type_of<bus::Writer>(spec, [&]<class Message>(const bus::Topic<Message>& topic) -> std::unique_ptr<bus::Writer> {
            return std::make_unique<MarkedWriter<Message>>(bus_.advertise(topic, options));
        });
    }
    std::unique_ptr<bus::Reader> make_reader(const bus::TopicSpec& spec) override
    {
        return with_type_of<bus::Reader>(spec, [&]<class Message>(const bus::Topic<Message>& topic) -> std::unique_ptr<bus::Reader> {
            return std::make_unique<MarkedReader<Message>>(bus_.subscribe(topic));
        });
    }

    bus::Bus& bus_;
};

constexpr std::uint64_t warm_up_frames = 300;
constexpr std::uint64_t counted_frames = 400;
constexpr std::int64_t patience_ns = 30'000'000'000;

class ServiceThread : public testing::TestWithParam<std::string> {};

TEST_P(ServiceThread, allocates_nothing_per_frame_in_our_code)
{
    const auto domain = 100 + static_cast<std::uint32_t>(::getpid() % 100);
    auto system = system::load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml",
                               {.dds = bus::vendor_from(GetParam()).value(), .domain = domain, .process = {}, .set = {"source.faults=[]"}});
    ASSERT_TRUE(system) << system.error();
    const auto quiet = [](system::ProcessSettings& process) { process.node.heartbeat = process.node.log_events = false; };
    quiet(system->sensor.process);
    for (auto& lane : system->lanes) {
        quiet(lane.detector.process);
        quiet(lane.integrator.process);
    }
    system->voters.resize(1);
    quiet(system->voters.front().process);
    system->sensor.consumers = {"voter-1"};

    const auto vendor = bus::open(system->sensor.process.bus);
    ASSERT_TRUE(vendor) << vendor.error();
    MarkedBus bus{**vendor};
    const runtime::SystemClock clock;
    const std::atomic<bool> never{false};
    runtime::EventLoop loop{bus, clock, never};
    voter::VoterService voter{system->voters.front(), bus, loop};
    std::vector<std::unique_ptr<integrator::AttitudeIntegrator>> integrators;
    std::vector<std::unique_ptr<detector::ParityFdi>> detectors;
    for (const auto& lane : system->lanes) {
        integrators.push_back(std::make_unique<integrator::AttitudeIntegrator>(lane.integrator, bus, loop));
        detectors.push_back(std::make_unique<detector::ParityFdi>(lane.detector, bus, loop));
    }
    auto source = sensor::make_source(system->sensor, 1);
    ASSERT_TRUE(source) << source.error();
    sensor::SensorPublisher publisher{system->sensor, std::move(*source), bus, loop};
    std::uint64_t voted = 0;
    loop.on(bus.subscribe(bus::topics::voter_output), [&](const VotedAttitude&) { ++voted; });

    const auto handle = [&](std::uint64_t frames) {
        const At here{Where::our_code};
        const auto deadline = clock.steady_ns() + patience_ns;
        while (voted < frames && clock.steady_ns() < deadline) {
            if (!loop.dispatch() && !loop.work()) bus.wait(1'000'000);
        }
    };
    handle(warm_up_frames);
    const auto ours_before = ours.load();
    const auto vendor_before = in_vendor_calls.load();
    const auto threads_before = on_vendor_threads.load();
    handle(warm_up_frames + counted_frames);

    ASSERT_GE(voted, warm_up_frames + counted_frames) << "the pipeline stood still";
    EXPECT_EQ(ours.load() - ours_before, 0U);
    const auto per_frame = [](std::uint64_t now, std::uint64_t before) { return static_cast<double>(now - before) / counted_frames; };
    std::printf("%s: per frame of three lanes and a voter: 0 in our code wanted, %.1f in vendor calls, %.1f on vendor threads\n",
                GetParam().c_str(), per_frame(in_vendor_calls, vendor_before), per_frame(on_vendor_threads, threads_before));
    RecordProperty("allocations_per_frame_in_vendor_calls", std::to_string(per_frame(in_vendor_calls, vendor_before)));
}

TEST_P(ServiceThread, would_count_an_allocation)
{
    const auto before = ours.load();
    {
        const At here{Where::our_code};
        ::operator delete(::operator new(64));
    }
    EXPECT_EQ(ours.load() - before, 1U);
}

INSTANTIATE_TEST_SUITE_P(Vendors, ServiceThread, testing::Values("cyclonedds", "fastdds"), [](const auto& vendor) { return vendor.param; });

}  // namespace

}  // namespace quorient
