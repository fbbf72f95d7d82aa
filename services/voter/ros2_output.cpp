#include "ros2_output.hpp"

#include "quorient/messages/name.hpp"

namespace quorient::voter {

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

/// ROS 2's diagnostics are expected at 1 Hz; a voter whose output did not come for so long is called silent, or no longer the owner.
constexpr std::int64_t diagnostics_period_ns = second_ns;

}  // namespace

Ros2Output::Ros2Output(const system::Ros2OutputSettings& settings, const voting::VoterSettings& voting, bus::Bus& bus,
                       runtime::EventLoop& loop)
    : settings_(settings),
      voting_(voting),
      loop_(loop),
      imus_(bus.advertise(bus::ros2::imu(settings_.imu.c_str(), bus::ros2::offered))),
      diagnostics_(bus.advertise(bus::ros2::diagnostics(settings_.diagnostics.c_str(), bus::ros2::offered)))
{
    for (const auto voter : voting_.voters) others_.push_back({voter, 0});
    loop.on(bus.subscribe(bus::topics::cluster), [this](const ClusterDescription& description) {
        if (description.unit != voting_.unit) return;
        description_ = description;
        covariance_of_ = 0;
    });
    loop.on(bus.subscribe(bus::topics::voter_output), [this](const VotedAttitude& output) { on_output(output); });
    loop.on(bus.subscribe(bus::topics::voted), [this](const VotedAttitude& voted) { on_voted(voted); });
    loop.every(diagnostics_period_ns, [this] { publish_diagnostics(); });
}

void Ros2Output::on_output(const VotedAttitude& output)
{
    if (output.unit != voting_.unit) return;
    for (auto& other : others_) {
        if (other.voter == output.voter) other.received_ns = loop_.clock().steady_ns();
    }
}

void Ros2Output::on_voted(const VotedAttitude& voted)
{
    if (voted.unit != voting_.unit) return;
    const auto stamp_ns = settings_.sample_time ? voted.sample_time_ns : host_time_.of(voted, loop_.clock().wall_ns());
    if (voted.voter != voting_.voter) {
        owned_ns_ = 0;
        return;
    }
    last_ = voted;
    owned_ns_ = loop_.clock().steady_ns();
    if (voted.sequence % settings_.every != 0) return;
    if (description_ && voted.used_mask != covariance_of_) {
        covariance_of_ = voted.used_mask;
        rate_covariance_ = rate_covariance(*description_, voted.used_mask);
    }
    auto imu = to_imu(voted, rate_covariance_);
    imu.stamp_ns = stamp_ns;
    copy_text(settings_.frame_id, imu.frame_id);
    imus_.publish(imu);
}

void Ros2Output::publish_diagnostics()
{
    const auto now = loop_.clock().steady_ns();
    if (owned_ns_ == 0 || now - owned_ns_ > diagnostics_period_ns) return;
    std::vector<VoterPresence> voters;
    for (const auto& other : others_) voters.push_back({other.voter, other.received_ns != 0 && now - other.received_ns < diagnostics_period_ns});
    to_diagnostics(last_, description_ ? &*description_ : nullptr, voting_.lanes, voters, array_);
    array_.stamp_ns = loop_.clock().wall_ns();
    diagnostics_.publish(array_);
}

}  // namespace quorient::voter
