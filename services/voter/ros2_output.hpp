#pragma once

#include "quorient/runtime/event_loop.hpp"
#include "quorient/system/system.hpp"
#include "ros2_messages.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace quorient::voter {

/// The voted attitude for ROS 2: rt/imu/data and rt/diagnostics. Both voters make one; each listens to the owned topic `voted` as any
/// foreign node does, and writes what it receives of itself. So DDS's own arbitration alone decides which voter writes.
class Ros2Output {
public:
    Ros2Output(const system::Ros2OutputSettings& settings, const voting::VoterSettings& voting, bus::Bus& bus, runtime::EventLoop& loop);

private:
    struct Other {
        std::uint32_t voter;
        std::int64_t received_ns;
    };

    void on_voted(const VotedAttitude& voted);
    void on_output(const VotedAttitude& output);
    void publish_diagnostics();

    system::Ros2OutputSettings settings_;
    voting::VoterSettings voting_;
    runtime::EventLoop& loop_;
    bus::Publisher<bus::ros2::Imu> imus_;
    bus::Publisher<bus::ros2::DiagnosticArray> diagnostics_;
    std::optional<ClusterDescription> description_;
    std::vector<Other> others_;
    HostTime host_time_;
    VotedAttitude last_;
    std::int64_t owned_ns_ = 0;
    AxisMask covariance_of_ = 0;
    std::array<double, 9> rate_covariance_{};
    bus::ros2::DiagnosticArray array_;
};

}  // namespace quorient::voter
