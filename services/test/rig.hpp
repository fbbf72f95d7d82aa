// One unit on the local bus under virtual time: what a service under test receives, and what it publishes.
#pragma once

#include "quorient/bus/local_bus.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/system/system.hpp"
#include "sources.hpp"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace quorient::test {

/// The demo's system, its faults left to the test.
inline system::System demo()
{
    system::Overrides without_faults;
    without_faults.set = {"source.faults=[]"};
    auto loaded = system::load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml", without_faults);
    if (!loaded) throw std::runtime_error(loaded.error());
    return std::move(*loaded);
}

template <class Settings>
Settings in_process(Settings settings)
{
    settings.process.node.heartbeat = false;
    settings.process.node.log_events = false;
    settings.process.bus.vendor = Vendor::local;
    return settings;
}

class Rig {
public:
    static constexpr std::uint64_t first_epoch = 1000;

    const system::System system = demo();

    /// A service with a bus and a loop of its own, as in its process; its end is the process's.
    template <class Service>
    class Process {
    public:
        template <class Settings>
        Process(Rig& rig, const Settings& settings)
            : bus_(rig.hub_.open()), loop_(*bus_, rig.clock_, rig.never_stop_), service_(in_process(settings), *bus_, loop_)
        {
        }

        void run()
        {
            while (loop_.dispatch() || loop_.work()) continue;
        }

    private:
        std::unique_ptr<bus::Bus> bus_;
        runtime::EventLoop loop_;
        Service service_;
    };

    Rig()
    {
        ear_.on(bus_->subscribe(bus::topics::verdict), [this](const FaultVerdict& verdict) {
            verdict_ = verdict;
            ++verdicts_;
            if (state_of(verdict) == VerdictState::suspect) ++suspicions_;
        });
        ear_.on(bus_->subscribe(bus::topics::attitude), [this](const AttitudeState& attitude) {
            attitude_ = attitude;
            ++attitudes_;
        });
        ear_.on(bus_->subscribe(bus::topics::event), [this](const HealthEvent& event) { events_.push_back(event); });
        begin_epoch(first_epoch);
    }

    /// A publisher that starts: the same motion, from its beginning.
    void begin_epoch(std::uint64_t epoch)
    {
        source_ = sensor::make_simulation_source(system.sensor, epoch);
        next_ = 0;
        publish(bus::topics::cluster, source_->description());
    }

    void inject(const std::string& fault)
    {
        const auto added = source_->faults().add(simulation::parse_fault(fault).value());
        if (!added) throw std::runtime_error(added.error());
    }
    void heal() { source_->faults().clear(); }

    /// The next frame, into `services`.
    template <class... Services>
    void frame(Services&... services)
    {
        SensorFrame frame;
        source_->advance_to(next_++, frame, truth_);
        pass_time(frame_ns);
        frame.stamp_ns[static_cast<std::size_t>(Hop::sensor)] = clock_.steady_ns() - late_ns_;
        publish(bus::topics::frame, frame);
        run(services...);
    }

    template <class... Services>
    void frames(unsigned count, Services&... services)
    {
        for (unsigned i = 0; i < count; ++i) frame(services...);
    }

    /// From now on services get frames so long after they were sent.
    void delay_frames(std::int64_t late_ns) { late_ns_ = late_ns; }

    /// Frames that nobody gets.
    void lose(std::uint64_t count)
    {
        next_ += count;
        pass_time(static_cast<std::int64_t>(count) * frame_ns);
    }

    void pass_time(std::int64_t span_ns) { clock_.set(clock_.steady_ns() + span_ns); }

    template <class... Services>
    void run(Services&... services)
    {
        (services.run(), ...);
        while (ear_.dispatch()) continue;
    }

    template <class Message>
    void publish(const bus::Topic<Message>& topic, const Message& message)
    {
        bus_->advertise(topic).publish(message);
    }

    std::int64_t now_ns() const { return clock_.steady_ns(); }
    std::uint64_t next_sequence() const { return next_; }
    const FaultVerdict& verdict() const { return verdict_; }
    const AttitudeState& attitude() const { return attitude_; }
    unsigned verdicts() const { return verdicts_; }    ///< so far
    unsigned suspicions() const { return suspicions_; }  ///< verdicts so far whose state is SUSPECT
    unsigned attitudes() const { return attitudes_; }  ///< so far
    const TruthState& truth() const { return truth_; }  ///< the newest frame's

    /// What was answered to this request, in order.
    std::vector<HealthEvent> answers(std::uint64_t request) const
    {
        return events_with([request](const HealthEvent& event) { return event.request == request; });
    }

    std::vector<HealthEvent> events(EventCode code) const
    {
        return events_with([code](const HealthEvent& event) { return event.code == octet(code); });
    }

private:
    static constexpr std::int64_t frame_ns = 5'000'000;

    template <class Predicate>
    std::vector<HealthEvent> events_with(Predicate wanted) const
    {
        std::vector<HealthEvent> found;
        std::ranges::copy_if(events_, std::back_inserter(found), wanted);
        return found;
    }

    bus::LocalHub hub_;
    runtime::VirtualClock clock_;
    std::atomic<bool> never_stop_{false};
    std::unique_ptr<bus::Bus> bus_ = hub_.open();
    runtime::EventLoop ear_{*bus_, clock_, never_stop_};
    std::unique_ptr<sensor::FrameSource> source_;
    std::uint64_t next_ = 0;
    std::int64_t late_ns_ = 0;
    TruthState truth_;
    FaultVerdict verdict_;
    AttitudeState attitude_;
    unsigned verdicts_ = 0;
    unsigned suspicions_ = 0;
    unsigned attitudes_ = 0;
    std::vector<HealthEvent> events_;
};

}  // namespace quorient::test
