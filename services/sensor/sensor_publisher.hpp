#pragma once

#include "frame_source.hpp"
#include "quorient/runtime/node.hpp"

#include <memory>
#include <set>
#include <string>

namespace quorient::sensor {

/// Publishes a unit's description, then its frames at their time. Promises: README.md.
class SensorPublisher {
public:
    SensorPublisher(const system::SensorSettings& settings, std::unique_ptr<FrameSource> source, bus::Bus& bus, runtime::EventLoop& loop);

    /// What the source met on its way, see FrameSource.
    std::string remarks() const { return source_->remarks(); }

private:
    void on_status(const ServiceStatus& status);
    void on_command(const FaultCommand& command);
    void start();
    void tick();
    bool publish(std::uint64_t sequence);
    void report_notices();
    std::int64_t due_ns(std::uint64_t sequence) const;
    double scenario_s() const;

    system::SensorSettings settings_;
    std::unique_ptr<FrameSource> source_;
    runtime::Node node_;
    bus::Publisher<ClusterDescription> descriptions_;
    bus::Publisher<SensorFrame> frames_;
    bus::Publisher<TruthState> truths_;
    runtime::Timer& wait_timer_;
    runtime::Timer& frame_timer_;
    runtime::Timer& end_timer_;
    std::set<std::string, std::less<>> missing_;
    SensorFrame frame_;
    TruthState truth_;
    bool started_ = false;
    std::int64_t start_ns_ = 0;
    std::int64_t interval_ns_;
    std::uint64_t next_ = 0;
};

}  // namespace quorient::sensor
