#pragma once

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/truth_state.hpp"
#include "quorient/settings/setting.hpp"
#include "quorient/simulation/faults.hpp"
#include "quorient/simulation/motion.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace quorient::simulation {

/// How an increment becomes a whole number of quanta.
enum class Quantize {
    none,
    carry,          ///< per axis: the accumulated angle is floored, the increment is the difference (the remainder is carried)
    truncate,       ///< per axis: each increment toward zero, the remainder is lost
    body_truncate,  ///< the three body increments toward zero, then projected on the axes (what paper 003's tables need)
};

/// The words `none`, `carry`, `truncate` and `body-truncate`, and which way each means.
std::vector<std::pair<std::string, Quantize>> quantize_words();

tl::expected<Quantize, std::string> parse_quantize(std::string_view word);

/// Everything that decides a simulated instrument's output.
struct Scenario {
    Motion motion;
    double interval_s = 0.005;
    double quantum = 0;  ///< [rad; m/s]
    Quantize quantize = Quantize::none;
    double noise_rad = 0;  ///< standard deviation of one increment of every axis, before quantisation [rad; m/s]
    std::uint64_t seed = 1;
    std::vector<FaultSpec> faults;
    double duration_s = 0;  ///< 0 = without end
};

/// What a user can set of it as a number.
settings::Record<Scenario> scenario_record();

/// What is wrong with a scenario for this cluster, or nothing: interval, quantum, noise, duration, faults.
tl::expected<void, std::string> check(const Scenario& scenario, const geometry::SensorCluster& cluster);

/// An instrument cluster on a moving body, as a function of the scenario's clock: what frame n holds does not depend on which frames
/// were asked for before. Sequence n covers [n, n + 1] intervals of the scenario's time, sample_time is its end.
class SimulatedInstrument {
public:
    /// @param scenario  must have passed check(); kind gyro measures rotation, accelerometer the specific force of a body at rest.
    SimulatedInstrument(const Scenario& scenario, const geometry::SensorCluster& cluster, std::uint32_t unit, SensorKind kind,
                        std::uint64_t epoch);

    /// Fills the frame and the truth at its end. Sequences may jump forward (never back): accumulated and missed include the frames
    /// between. Stamps, known_input and description_revision are left as they are. Allocates nothing.
    void advance_to(std::uint64_t sequence, SensorFrame& frame, TruthState& truth);

    FaultInjector& faults() { return faults_; }

    /// q_RB (w,x,y,z) at the start of sequence 0.
    std::array<double, 4> initial_attitude() const;

    /// How many frames the scenario's duration has; UINT64_MAX without end.
    std::uint64_t frame_count() const;

private:
    void produce(std::uint64_t sequence, SensorFrame& frame);
    double quantised(std::size_t axis, double increment);

    Scenario scenario_;
    geometry::SensorCluster cluster_;
    FaultInjector faults_;
    FrameAccumulator accumulator_;
    std::array<double, max_axes> remainder_{};  // carry: the part of the accumulated angle below one quantum
    std::uint64_t next_ = 0;
    AxisMask touched_ = 0;
    std::uint64_t epoch_;
    std::uint32_t unit_;
    SensorKind kind_;
};

}  // namespace quorient::simulation
