#pragma once

#include "integrator_service.hpp"
#include "detector_service.hpp"
#include "quorient/bus/local_bus.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "report/replay_report.hpp"
#include "report/run_timeline.hpp"
#include "quorient/evaluation/run_observer.hpp"
#include "sensor_publisher.hpp"
#include "voter_service.hpp"

#include <atomic>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::replay {

/// Every process of a system in one thread, on the local bus, under virtual time: the same objects as live, bit-identical on every run.
class Offline {
public:
    /// @param log       what a table does not say itself
    /// @param timeline  may be absent
    Offline(system::System system, evaluation::RunObserver& observer, report::ReplayReport& report, const recording::LogOptions& log,
            report::RunTimeline* timeline = nullptr);

    /// Calls `handler` with each message of a topic. To be called before run().
    template <class Topic, class Handler>
    void watch(const Topic& topic, Handler handler)
    {
        loop_.on(bus_->subscribe(topic), std::move(handler));
    }

    /// Until the source ends. @returns what is wrong with the source.
    tl::expected<void, std::string> run();

    /// The latest status of the first lane's detector: what its intake refused.
    const ServiceStatus& intake() const { return intake_; }

    /// What the source met on its way: of a log, what it refused and why, counted.
    const std::string& remarks() const { return remarks_; }

private:
    void observe(evaluation::RunObserver& observer, report::ReplayReport& report);
    void draw(report::RunTimeline& timeline);

    system::System system_;
    recording::LogOptions log_;
    runtime::VirtualClock clock_;
    std::atomic<bool> never_stop_{false};
    bus::LocalHub hub_;
    std::unique_ptr<bus::Bus> bus_;
    runtime::EventLoop loop_;
    std::vector<std::unique_ptr<voter::VoterService>> voters_;
    std::vector<std::unique_ptr<integrator::IntegratorService>> integrators_;
    std::vector<std::unique_ptr<detector::DetectorService>> detectors_;
    ServiceStatus intake_;
    std::string remarks_;
};

}  // namespace quorient::replay
