#include "ros2_messages.hpp"

#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <Eigen/LU>
#include <algorithm>

namespace quorient::voter {

using bus::ros2::DiagnosticArray;
using bus::ros2::DiagnosticStatus;
using bus::ros2::Imu;
using bus::ros2::Level;

namespace {

constexpr double not_measured = -1;

bool has_orientation(const VotedAttitude& voted)
{
    const auto mode = mode_of(voted);
    return level_of(voted) != VoteLevel::lost && mode != AttitudeMode::lost && mode != AttitudeMode::initialising;
}

/// The next status of the array; nothing when it is full.
DiagnosticStatus* next(DiagnosticArray& array, std::uint32_t unit, const std::string& name, Level level, std::string_view message)
{
    if (array.count == array.status.size()) return nullptr;
    auto& status = array.status[array.count++];
    status = {};
    status.level = octet(level);
    copy_text(fmt::format("quorient: {}", name), status.name);
    copy_text(message, status.message);
    copy_text(fmt::format("unit {}", unit), status.hardware_id);
    return &status;
}

void add(DiagnosticStatus* status, std::string_view key, const std::string& value)
{
    if (!status || status->value_count == status->values.size()) return;
    auto& entry = status->values[status->value_count++];
    copy_text(key, entry.key);
    copy_text(value, entry.value);
}

void add_axes(const VotedAttitude& voted, const ClusterDescription& description, DiagnosticArray& array)
{
    const std::size_t count = std::min<std::size_t>(description.axis_count, max_axes);
    for (std::size_t axis = 0; axis < count; ++axis) {
        const auto name = fmt::format("axis {} ({})", axis, axis_name(description, axis));
        if (has_axis(voted.isolated_mask, axis))
            add(next(array, voted.unit, name, Level::error, "isolated"), "first bad frame", std::to_string(voted.excluded_from[axis]));
        else if (has_axis(voted.suspect_mask, axis)) next(array, voted.unit, name, Level::warning, "suspect");
        else if (has_axis(voted.used_mask, axis)) next(array, voted.unit, name, Level::ok, "in use");
        else next(array, voted.unit, name, Level::warning, "no measurement");
    }
}

void add_lanes(const VotedAttitude& voted, const std::vector<voting::LaneSettings>& lanes, DiagnosticArray& array)
{
    for (std::size_t place = 0; place < lanes.size(); ++place) {
        const auto name = fmt::format("lane {}", lanes[place].name);
        const auto why = static_cast<LaneExclusion>(voted.excluded_why[place]);
        if (lanes[place].lane == voted.primary_lane) next(array, voted.unit, name, Level::ok, "primary");
        else if ((voted.vouching_mask >> place & 1U) != 0) next(array, voted.unit, name, Level::ok, "vouches");
        else next(array, voted.unit, name, why == LaneExclusion::silent ? Level::error : Level::warning, to_string(why));
    }
}

Level diagnostic_level(VoteLevel level)
{
    switch (level) {
        case VoteLevel::full:
            return Level::ok;
        case VoteLevel::degraded:
            return Level::warning;
        default:
            return Level::error;
    }
}

}  // namespace

std::array<double, 9> rate_covariance(const ClusterDescription& description, AxisMask used)
{
    std::array<double, 9> covariance{};
    if (!(description.interval_s > 0)) return covariance;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (std::size_t axis = 0; axis < std::min<std::size_t>(description.axis_count, max_axes); ++axis) {
        const double variance =
            description.sigma[axis] * description.sigma[axis] + description.quantum[axis] * description.quantum[axis] / 12;
        if (!has_axis(used, axis) || !(variance > 0)) continue;
        const Eigen::Map<const Eigen::Vector3d> direction(description.axis[axis].data());
        information += direction * direction.transpose() / variance;
    }
    const Eigen::FullPivLU<Eigen::Matrix3d> solver(information);
    if (!solver.isInvertible()) return covariance;
    Eigen::Map<Eigen::Matrix3d>(covariance.data()) = solver.inverse() / (description.interval_s * description.interval_s);
    return covariance;
}

Imu to_imu(const VotedAttitude& voted, const std::array<double, 9>& rate_covariance)
{
    Imu imu;
    imu.orientation = voted.attitude;
    const double variance = voted.angle_sigma_rad * voted.angle_sigma_rad / 3;
    imu.orientation_covariance = {variance, 0, 0, 0, variance, 0, 0, 0, variance};
    if (!has_orientation(voted)) imu.orientation_covariance[0] = not_measured;
    imu.rate_rad_s = voted.rate_rad_s;
    imu.rate_covariance = rate_covariance;
    imu.acceleration_covariance[0] = not_measured;
    return imu;
}

std::int64_t HostTime::of(const VotedAttitude& voted, std::int64_t wall_now_ns)
{
    const auto offset = wall_now_ns - voted.sample_time_ns;
    offset_ns_ = voted.epoch == epoch_ ? std::min(offset, offset_ns_) : offset;
    epoch_ = voted.epoch;
    return voted.sample_time_ns + offset_ns_;
}

void to_diagnostics(const VotedAttitude& voted, const ClusterDescription* description, const std::vector<voting::LaneSettings>& lanes,
                    const std::vector<VoterPresence>& voters, DiagnosticArray& array)
{
    array.count = 0;
    auto* own = next(array, voted.unit, "attitude", diagnostic_level(level_of(voted)), to_string(level_of(voted)));
    add(own, "mode", std::string{to_string(mode_of(voted))});
    add(own, "angle sigma [rad]", fmt::format("{:.3g}", voted.angle_sigma_rad));
    add(own, "lanes' spread [rad]", fmt::format("{:.3g}", voted.spread_rad));
    add(own, "frame", std::to_string(voted.sequence));
    add(own, "output", std::to_string(voted.output_sequence));
    for (const auto& presence : voters) {
        const auto name = fmt::format("voter {}", presence.voter);
        if (presence.voter == voted.voter) next(array, voted.unit, name, Level::ok, "owns the output");
        else next(array, voted.unit, name, presence.alive ? Level::ok : Level::error, presence.alive ? "stands by" : "silent");
    }
    add_lanes(voted, lanes, array);
    if (description) add_axes(voted, *description, array);
}

}  // namespace quorient::voter
