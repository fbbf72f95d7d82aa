#pragma once

#include "imu_stream.hpp"
#include "quorient/bus/ros2.hpp"
#include "quorient/system/system.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace quorient::sensor {

/// Several IMUs with stamps of their own become frames of one clock.
///
/// The common clock is the steady clock plus the median of the IMUs' (stamp - arrival), followed at 1e-3 at most; only a jump that most
/// IMUs make together is followed at once. Frames end `skew` behind the common clock, so that whoever is less late than that is in.
/// An IMU whose stamps are further off than `skew` (late, jumping), stand still or step back (duplicated), that two nodes publish, or
/// that has no sample around the interval (silent, or gaps above `skew`), measures nothing in that frame.
class ImuAlignment {
public:
    enum class Fault { none, silent, skewed, disordered, duplicated, not_finite };

    struct Instrument {
        bool valid = false;
        Eigen::Vector3d increment = Eigen::Vector3d::Zero();  ///< in the IMU's own frame [rad; m/s]
        Fault fault = Fault::none;                            ///< why it is not valid
    };

    ImuAlignment(const system::Ros2SourceSettings& settings, SensorKind kind, double interval_s);

    /// @param publishers  nodes that write this IMU's topic.
    void add(std::size_t imu, const bus::ros2::Imu& message, std::int64_t arrival_ns, std::uint32_t publishers);

    /// Whether the first frame can begin: every IMU has been received for two skews, or one has for a second.
    bool ready(std::int64_t now_ns) const;

    /// The first frame's interval begins here.
    void start(std::int64_t now_ns);

    /// One interval on. @param now_ns  steady.
    void advance(std::int64_t now_ns);

    std::int64_t begin_ns() const { return begin_ns_; }  ///< the interval's, on the common clock
    std::int64_t end_ns() const { return end_ns_; }
    const std::vector<Instrument>& instruments() const { return instruments_; }

    /// The IMUs' clock stepped, and the frames followed, so often.
    std::uint64_t clock_steps() const { return clock_steps_; }

private:
    struct Received {
        ImuStream stream;
        Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  ///< the newest sample's, for the lever arm
        std::int64_t rate_stamp_ns = 0;
        std::int64_t offset_ns = 0;  ///< stamp - arrival of the newest message, whether it was taken or not
        std::int64_t arrival_ns = 0;
        std::int64_t first_arrival_ns = 0;
        std::int64_t stamp_ns = 0;
        std::int64_t faulty_until_ns = 0;  ///< steady
        Fault fault = Fault::none;
    };

    Eigen::Vector3d value_of(std::size_t imu, Received& received, const bus::ros2::Imu& message) const;
    std::optional<std::int64_t> median_offset(std::int64_t now_ns) const;
    void follow_clock(std::int64_t now_ns);
    void blame(Received& received, Fault fault, std::int64_t arrival_ns) const;

    system::Ros2SourceSettings settings_;
    SensorKind kind_;
    std::int64_t interval_ns_;
    std::int64_t skew_ns_;
    std::vector<Received> received_;
    std::vector<Instrument> instruments_;
    std::optional<std::int64_t> offset_ns_;  ///< common clock - steady clock
    std::int64_t begin_ns_ = 0;
    std::int64_t end_ns_ = 0;
    std::int64_t stepped_since_ns_ = 0;
    std::uint64_t clock_steps_ = 0;
};

std::string_view to_string(ImuAlignment::Fault fault);

}  // namespace quorient::sensor
