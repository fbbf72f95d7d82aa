// What a frame's way through all services costs on the service thread: our code allocates, locks, logs and throws nothing; what the
// vendor's calls and threads do is counted apart and printed.

#include "integrator_service.hpp"
#include "detector_service.hpp"
#include "quorient/bus/bus.hpp"
#include "sensor_publisher.hpp"
#include "voter_service.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
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

enum class What { allocation, lock, exception, log };

thread_local Where where = Where::elsewhere;

using Counts = std::array<std::array<std::uint64_t, 4>, 3>;
std::array<std::array<std::atomic<std::uint64_t>, 4>, 3> counters{};

void count(What what)
{
    counters[static_cast<std::size_t>(where)][static_cast<std::size_t>(what)].fetch_add(1, std::memory_order_relaxed);
}

std::uint64_t counted(Where here, What what)
{
    return counters[static_cast<std::size_t>(here)][static_cast<std::size_t>(what)].load(std::memory_order_relaxed);
}

Counts counted()
{
    Counts now{};
    for (std::size_t here = 0; here < now.size(); ++here) {
        for (std::size_t what = 0; what < now[here].size(); ++what)
            now[here][what] = counted(static_cast<Where>(here), static_cast<What>(what));
    }
    return now;
}

template <class Function>
Function next(const char* name)
{
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
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
    count(What::allocation);
    return __libc_malloc(size);
}
extern "C" void* calloc(std::size_t number, std::size_t size)
{
    count(What::allocation);
    return __libc_calloc(number, size);
}
extern "C" void* realloc(void* memory, std::size_t size)
{
    count(What::allocation);
    return __libc_realloc(memory, size);
}
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex)
{
    static const auto lock = next<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
    count(What::lock);
    return lock(mutex);
}
extern "C" [[noreturn]] void __cxa_throw(void* thrown, void* type, void (*destroy)(void*))
{
    static const auto raise = next<void (*)(void*, void*, void (*)(void*))>("__cxa_throw");
    count(What::exception);
    raise(thrown, type, destroy);
    std::abort();
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

/// A vendor's bus whose calls are counted apart from our code. The bus room's own few lines (a copy of the sample) count as the vendor's.
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
    std::unique_ptr<bus::Reader> make_reader(const bus::TopicSpec& spec, const bus::ReaderOptions& options) override
    {
        return with_type_of<bus::Reader>(spec, [&]<class Message>(const bus::Topic<Message>& topic) -> std::unique_ptr<bus::Reader> {
            return std::make_unique<MarkedReader<Message>>(bus_.subscribe(topic, options));
        });
    }

    bus::Bus& bus_;
};

/// In the place of the log.
class CountingSink final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
    void sink_it_(const spdlog::details::log_msg&) override { count(What::log); }
    void flush_() override {}
};

void count_logs()
{
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("counted", std::make_shared<CountingSink>()));
}

constexpr std::uint64_t warm_up_frames = 300;
constexpr std::uint64_t counted_frames = 400;
constexpr std::int64_t patience_ns = 30'000'000'000;

class ServiceThread : public testing::TestWithParam<std::string> {};

TEST_P(ServiceThread, allocates_locks_logs_and_throws_nothing_per_frame_in_our_code)
{
    count_logs();
    ::setenv("QUORIENT_RUN_DIR", testing::TempDir().c_str(), 1);
    const auto domain = 100 + static_cast<std::uint32_t>(::getpid() % 100);
    auto system = system::load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml",
                               {.dds = bus::vendor_from(GetParam()).value(), .domain = domain, .processes = {}, .set = {"source.faults=[]"}});
    ASSERT_TRUE(system) << system.error();
    system->voters.resize(1);
    system->sensor.consumers = {"voter-1"};

    const auto vendor = bus::open(system->sensor.process.bus);
    ASSERT_TRUE(vendor) << vendor.error();
    MarkedBus bus{**vendor};
    const runtime::SystemClock clock;
    const std::atomic<bool> never{false};
    runtime::EventLoop loop{bus, clock, never};
    voter::VoterService voter{system->voters.front(), bus, loop};
    std::vector<std::unique_ptr<integrator::IntegratorService>> integrators;
    std::vector<std::unique_ptr<detector::DetectorService>> detectors;
    for (const auto& lane : system->lanes) {
        integrators.push_back(std::make_unique<integrator::IntegratorService>(lane.integrator, bus, loop));
        detectors.push_back(std::make_unique<detector::DetectorService>(lane.detector, bus, loop));
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
    const auto before = counted();
    handle(warm_up_frames + counted_frames);

    const auto after = counted();

    ASSERT_GE(voted, warm_up_frames + counted_frames) << "the pipeline stood still";
    for (const auto& [what, name] :
         {std::pair{What::allocation, "allocations"}, {What::lock, "locks"}, {What::exception, "exceptions"}, {What::log, "log lines"}}) {
        const auto per_frame = [&](Where here) {
            const auto i = static_cast<std::size_t>(here), k = static_cast<std::size_t>(what);
            return static_cast<double>(after[i][k] - before[i][k]) / counted_frames;
        };
        EXPECT_EQ(per_frame(Where::our_code), 0) << name << " per frame";
        std::printf("%s, %s per frame of three lanes and a voter: %.2f in our code, %.1f in vendor calls, %.1f on vendor threads\n",
                    GetParam().c_str(), name, per_frame(Where::our_code), per_frame(Where::vendor_call), per_frame(Where::elsewhere));
    }
}

INSTANTIATE_TEST_SUITE_P(Vendors, ServiceThread, testing::Values("cyclonedds", "fastdds"), [](const auto& vendor) { return vendor.param; });

TEST(ServiceThreadCounters, would_see_an_allocation_a_lock_an_exception_and_a_log_line)
{
    count_logs();
    const auto before = counted();
    {
        const At here{Where::our_code};
        ::operator delete(::operator new(64));
        pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
        pthread_mutex_lock(&mutex);
        pthread_mutex_unlock(&mutex);
        EXPECT_THROW(throw std::runtime_error("counted"), std::runtime_error);
        spdlog::info("counted");
    }
    for (const auto what : {What::allocation, What::lock, What::exception, What::log})
        EXPECT_GT(counted(Where::our_code, what), before[static_cast<std::size_t>(Where::our_code)][static_cast<std::size_t>(what)]);
}

}  // namespace

}  // namespace quorient
