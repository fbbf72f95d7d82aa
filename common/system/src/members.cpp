#include "quorient/system/members.hpp"

#include "quorient/bus/topics.hpp"

namespace quorient::system {

using security::Member;
using security::Role;

namespace {

Member member(const ProcessSettings& process, Role role)
{
    return {process.node.name, role, security::access_of(role)};
}

Member sensor_of(const System& system)
{
    auto sensor = member(system.sensor.process, Role::sensor);
    if (const auto& ros2 = system.sensor.source.ros2) {
        for (const auto& imu : ros2->imus) sensor.access.subscribes.push_back(imu.topic);
    }
    return sensor;
}

Member member_of(const VoterProcess& voter)
{
    auto member = system::member(voter.process, Role::voter);
    if (voter.ros2) {
        member.access.publishes.push_back(voter.ros2->imu);
        member.access.publishes.push_back(voter.ros2->diagnostics);
        member.access.subscribes.push_back(bus::topics::cluster.spec.name);  // axes, for the rate
        member.access.subscribes.push_back(bus::topics::voted.spec.name);    // the owner publishes for ROS 2
    }
    return member;
}

}  // namespace

std::vector<Member> members_of(const System& system)
{
    std::vector<Member> members{sensor_of(system)};
    for (const auto& lane : system.lanes) {
        members.push_back(member(lane.detector.process, Role::detector));
        if (system.has_attitude()) members.push_back(member(lane.integrator.process, Role::integrator));
    }
    for (const auto& voter : system.voters) members.push_back(member_of(voter));
    members.push_back(member(system.monitor, Role::monitor));
    members.push_back({operator_name, Role::commander, security::access_of(Role::commander)});
    return members;
}

}  // namespace quorient::system
