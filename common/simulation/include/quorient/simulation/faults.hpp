#pragma once

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/fault_command.hpp"
#include "quorient/messages/sensor_frame.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::simulation {

/// One fault as a user states it: `axis=1,kind=scale,value=0.8,start=8,end=18`. The kinds and their units: README.md.
struct FaultSpec {
    AxisMask axes = 0;
    std::string instrument;  ///< instead of axes: all axes of the instrument of this name (or 0-based number)
    FaultKind kind = FaultKind::unknown;
    double value = 0;  ///< unit by kind
    double start_s = 0;
    double end_s = std::numeric_limits<double>::infinity();
    double frequency_hz = 0;
    double period_s = 0;
};

/// The axes that a text with names stands for, as in `IMU3 y+2`.
using AxisNames = std::function<tl::expected<AxisMask, std::string>(std::string_view text)>;

/// Reads `key=value` pairs divided by commas. Keys: axis (0-based; several: 1+3), instrument, kind, value, start, end, frequency, period.
/// @param names  what axis= holds beside numbers; asked last, when all else is right. Without it axes are numbers.
/// @returns an error that names the offending word and lists the valid ones.
tl::expected<FaultSpec, std::string> parse_fault(std::string_view text, const AxisNames& names = {});

/// The text that parse_fault reads back.
std::string to_string(const FaultSpec& fault);

/// The kind as text, e.g. "scale" (README.md lists all).
std::string_view to_string(FaultKind kind);

/// The command `inject` for a fault whose axes are resolved, and back. A command's times count from `now_s`.
FaultCommand to_command(const FaultSpec& fault);
FaultSpec from_command(const FaultCommand& command, double now_s);

/// The fault with `axes` filled from `instrument`; refuses an axis, instrument or figure that the cluster does not have
/// (rail needs a stated range, noise a sigma, delay at most delay_history_frames intervals).
tl::expected<FaultSpec, std::string> resolve(const FaultSpec& fault, const geometry::SensorCluster& cluster);

/// Applies faults to the frames of one instrument cluster, simulated, recorded or live: its output is what a broken axis would send.
///
/// A fault acts on a frame if the middle of the frame's interval lies in [start, end). Faults act in the order of their addition.
/// `apply` must be given every frame, in order (stuck and delay need the past). It allocates nothing.
class FaultInjector {
public:
    static constexpr std::size_t delay_history_frames = 1024;
    static constexpr std::size_t capacity = 64;

    /// @param seed  for noise and dropout faults, which are functions of (seed, axis, sequence).
    FaultInjector(geometry::SensorCluster cluster, std::uint64_t seed);

    /// Faults that have ended make room. @returns an error as from resolve, or that all places are taken.
    tl::expected<void, std::string> add(const FaultSpec& fault);

    void clear() { faults_.clear(); }

    /// Takes these axes out of every fault.
    void clear(AxisMask axes);

    /// Changes increment and valid_mask of the frame whose interval begins at begin_s of the scenario's time.
    /// accumulated and missed are not touched: FrameAccumulator comes after.
    /// @returns the axes whose increment or validity really changed.
    AxisMask apply(SensorFrame& frame, double begin_s);

    /// The axes of all faults that would act at this time.
    AxisMask active_axes(double time_s) const;

    bool empty() const { return faults_.empty(); }

private:
    struct Active {
        FaultSpec fault;
        AxisMask captured = 0;                // axes whose held value was taken at the onset
        std::array<double, max_axes> held{};  // stuck: the last value; rail: the limit with the sign at the onset
    };

    void apply(Active& active, std::size_t axis, SensorFrame& frame, double begin_s);
    void delay(double delay_s, std::size_t axis, SensorFrame& frame) const;
    void remember(const SensorFrame& frame);

    geometry::SensorCluster cluster_;
    std::uint64_t seed_ = 0;
    std::vector<Active> faults_;
    double newest_s_ = -std::numeric_limits<double>::infinity();  ///< middle of the newest frame
    std::array<double, max_axes> last_value_{};                   // newest output of each axis
    AxisMask has_last_value_ = 0;
    std::vector<std::array<double, max_axes>> history_;  // ring of measured increments, newest at history_count_ - 1
    std::uint64_t history_count_ = 0;
};

/// Fills accumulated and missed of consecutive frames: what lets a consumer bridge a lost frame without losing rotation.
/// An increment that is not finite counts as missed.
class FrameAccumulator {
public:
    void add(SensorFrame& frame);

    /// Frames that the instrument itself lost: every axis missed that many.
    void skip(std::uint32_t frames);

private:
    std::array<double, max_axes> accumulated_{};
    std::array<std::uint32_t, max_axes> missed_{};
};

}  // namespace quorient::simulation
