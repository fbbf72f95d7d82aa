#pragma once

#include "quorient/geometry/zero_order_hold.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/settings/setting.hpp"
#include "quorient/simulation/faults.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::simulation {

/// A surface vessel at constant forward speed, second-order Nomoto model. [paper 001, eqs 1-8]
/// Printed in the paper: the hydrodynamic derivatives (Y_vdot as "3,5"). Not printed, our assumption: mass, inertia, centre of mass, speed.
struct VesselCoefficients {
    double mass = 15;               ///< m
    double inertia = 8;             ///< I_z, about the vertical axis
    double centre_of_mass_x = 0.5;  ///< x_G, ahead of the origin
    double speed = 2;               ///< u_0, forward
    double y_v = 5, y_d = 7, y_v_dot = 3.5, y_d_dot = 7,
           y_rudder = 4;  ///< sway force by sway velocity v, yaw rate d, their derivatives, rudder
    double n_v = 3, n_d = 7, n_v_dot = 5, n_d_dot = 7, n_rudder = 4;  ///< yaw moment, likewise
};

/// x' = A x + B u, y = C x. For a vessel x = (sway velocity, yaw rate), u = rudder angle, C = I.
struct VesselModel {
    Eigen::MatrixXd a, b, c;
};

/// A = -M^-1 N, B = M^-1 b with
///   M = [m - Y_vdot, m x_G - Y_ddot; m x_G - N_vdot, I_z - N_ddot],  N = [-Y_v, m u_0 - Y_d; -N_v, m x_G u_0 - N_d],  b = (Y_rudder,
///   N_rudder).
/// @returns that M is singular or a coefficient not finite.
tl::expected<VesselModel, std::string> nomoto(const VesselCoefficients& coefficients);

/// The gyro fault and the fault of the accelerometer channel of paper 001: 0.01 on the yaw rate during 20-30 s, on the sway velocity during
/// 50-70 s.
std::vector<FaultSpec> paper_faults();

struct VesselScenario {
    VesselModel model;
    std::vector<std::string> channels;  ///< their names; empty: channel0, channel1, ...
    double rudder_rad = 0.01;           ///< amplitude of a sine
    double rudder_period_s = 20;
    double rudder_lost_from_s = std::numeric_limits<double>::infinity();  ///< from here on the rudder moves unreported
    double rudder_lost_to_s = std::numeric_limits<double>::infinity();    ///< end of that
    double interval_s = 0.01;
    double duration_s = 80;
    double noise = 0;  ///< standard deviation of every sample, in the channel's unit
    std::uint64_t seed = 1;
    std::vector<FaultSpec> faults;  ///< axis = channel (0 sway velocity, 1 yaw rate); the times of samples count
};

/// What a user can set of it as a number, and of its rudder.
settings::Record<VesselScenario> vessel_record();
settings::Record<VesselScenario> rudder_record();

/// The channels as a description names them and as faults act on them: each its own instrument, no directions.
geometry::SensorCluster channels_of(const VesselScenario& scenario);

/// @returns what is wrong: sizes, figures, a fault on a channel that is not there.
tl::expected<void, std::string> check(const VesselScenario& scenario);

/// The vessel and its sensors, one frame per interval. Frame k is sampled at time k h. An increment is the sample times the
/// interval, so that it stands for a mean rate. The rudder is the known input (NaN while it is lost) and is held over an interval; the
/// motion is exact.
class SimulatedVessel {
public:
    /// @param scenario  has passed check().
    explicit SimulatedVessel(const VesselScenario& scenario);

    /// The next frame, and the true state at its time. @returns false at the end of the scenario.
    bool next(SensorFrame& frame, Eigen::VectorXd& state);

    double time_s() const { return static_cast<double>(sequence_) * scenario_.interval_s; }
    std::uint64_t frame_count() const { return frames_; }

    /// The channels that a fault really touched in the newest frame.
    AxisMask faulty() const { return faulty_; }

    FaultInjector& faults() { return faults_; }

private:
    double rudder_at(double time) const;

    VesselScenario scenario_;
    geometry::ZeroOrderHold hold_;
    FaultInjector faults_;
    FrameAccumulator accumulator_;
    AxisMask faulty_ = 0;
    Eigen::VectorXd state_;
    std::uint64_t sequence_ = 0;
    std::uint64_t frames_;
};

}  // namespace quorient::simulation
