#pragma once

#include "lane_pace.hpp"
#include "quorient/runtime/node.hpp"
#include "quorient/runtime/shedding.hpp"
#include "quorient/system/system.hpp"
#include "quorient/voting/voter.hpp"
#include "ros2_output.hpp"

#include <optional>

namespace quorient::voter {

/// One attitude out of many lanes. Promises: README.md.
class VoterService {
public:
    VoterService(const system::VoterProcess& settings, bus::Bus& bus, runtime::EventLoop& loop);

private:
    void on_attitude(const AttitudeState& attitude);
    bool keep_pace(const AttitudeState& attitude);
    void drain();
    void stamp(VotedAttitude& output);
    void copy_counters();

    system::VoterProcess settings_;
    runtime::Node node_;
    bus::Publisher<VotedAttitude> outputs_;
    bus::Publisher<VotedAttitude> voted_;
    runtime::Shedding shedding_;
    LanePace pace_;
    bool paced_ = false;  ///< this voter or a lane sheds
    bus::Subscription<AttitudeState>* attitudes_ = nullptr;
    runtime::Timer& poll_timer_;
    voting::Voter brain_;
    VotedAttitude output_;
    std::int64_t arrival_ns_ = 0;
    std::optional<Ros2Output> ros2_;
};

}  // namespace quorient::voter
