#pragma once

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::attitude {

struct IntegratorSettings {
    std::string algorithm = "window-10";                 ///< as in `quorient propagate`, see update.hpp
    double history_s = 10;                               ///< how far back a verdict can still be honoured
    bool rollback = true;                                ///< false: a verdict acts from the next frame on (for comparison)
    std::array<double, 4> initial_attitude{1, 0, 0, 0};  ///< q_RB at the start of sequence 0 (w,x,y,z)
    double initial_sigma_rad = 0;
    bool initialised = true;         ///< false: mode INITIALISING until seed() or reset()
    bool leave_out_suspects = true;  ///< a named suspect is left out while it is suspected
    double lost_after_s = 1;         ///< without three trusted axes for longer than this: LOST instead of COASTING
    std::uint32_t unit = 0;
    std::uint32_t lane = 0;
};

/// The brain of the integrator process: increments of a gyro cluster and verdicts about them in, one attitude per frame out.
///
/// The attitude is a pure function of the frames and of the verdicts delivered so far, never of the order or the number of
/// calls: every frame of the history keeps its raw increments, and a verdict that changes which axes are trusted at a past
/// frame makes everything from that frame on be integrated again by the same code. So after all verdicts are in, the
/// attitude equals bit for bit that of a run which had them at once.
///
/// Nothing is allocated after make(). Not thread-safe.
class Integrator {
public:
    /// @returns what is wrong with the settings (algorithm, history, attitude) or the cluster (kind, interval).
    static tl::expected<Integrator, std::string> make(const IntegratorSettings& settings, const geometry::SensorCluster& cluster);

    Integrator(Integrator&&) noexcept;
    Integrator& operator=(Integrator&&) noexcept;
    ~Integrator();

    /// Integrates one frame. Frames have passed the intake: identities newer than the last one, valid axes finite,
    /// interval above 0. Frames that never arrived are bridged by `accumulated` for the axes whose `missed` did not change.
    /// A frame of a newer epoch starts a new history; what turned in between is not known: mode LOST until seed(), reset()
    /// or begin_epoch().
    void add(const SensorFrame& frame);

    /// Any order, repeated, late, or early (before its frame). At most a bounded slice of the roll-back that it may cause is
    /// done here; the rest by work(), at the latest slice by slice in add().
    void apply(const FaultVerdict& verdict);

    /// One bounded slice (at most 128 frames) of a pending roll-back. @returns true while more is left.
    bool work();

    /// The attitude of the newest frame. While a roll-back is pending it follows the old track; then the correction appears as
    /// a whole, with reset_counter + 1 if an attitude that was published has changed, and with
    /// reset_rotation = q_new o conj(q_old) at the newest frame that was published.
    AttitudeState state() const;

    /// state(), and from now on the newest frame counts as published: what changes it later is a reset. (Adding the next frame
    /// has the same effect.) Between add() and publish() a verdict on the newest frame changes its attitude without a reset.
    AttitudeState publish();

    /// A lane's verdict reached further back than the history: its correction is incomplete. Counts such verdicts.
    std::uint64_t history_too_short() const;

    /// Take-over after a restart: attitude, exclusions and identity of the voted attitude; mode stays INITIALISING until the
    /// first frame after that identity has been integrated. Flag SEEDED from then on, until reset().
    void seed(const VotedAttitude& voted);

    /// Axes that the newest verdict excludes from the seed's frame on or before, and the seed did not: its attitude has their fault in
    /// it, and no roll-back reaches there. 0 where it is sound, or there was none. A later seed from who has corrected itself mends it.
    AxisMask distrusted_in_seed() const;

    /// Of the exclusions taken over by seed(), these may be cleared by a verdict that does not share them. Without it only a
    /// detector that has once excluded the axis itself clears it: one that was away at the onset may be unable to name it.
    void let_go(AxisMask axes);

    /// By command: the attitude at the end of this sequence is this; the frames after it are integrated again from there, so that
    /// lanes that hear it at different frames agree. Announced as a reset; history before it is closed.
    /// @returns false where the history does not reach that frame, or it has not come yet: nothing is changed.
    bool reset(const std::array<double, 4>& attitude, std::uint64_t sequence);

    /// The description of an epoch states the attitude at the start of its sequence 0: the first frame of that epoch starts
    /// from it, without mode LOST.
    void begin_epoch(std::uint64_t epoch, const std::array<double, 4>& attitude);

private:
    class Engine;
    explicit Integrator(std::unique_ptr<Engine> engine);

    std::unique_ptr<Engine> engine_;
};

}  // namespace quorient::attitude
