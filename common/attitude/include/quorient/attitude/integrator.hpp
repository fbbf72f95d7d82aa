#pragma once

#include "quorient/attitude/body_increment.hpp"
#include "quorient/attitude/integrator_settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::attitude {

class Announcement;
class FrameStream;
class History;
class Integration;
class Start;
class Trust;
class Update;
struct Opinion;
struct Record;
struct Standing;

/// The brain of the integrator process: increments of a gyro cluster and verdicts about them in, one attitude per frame out.
/// Derivation, rules and limits: docs/methods/quaternion_integration.md.
///
/// The attitude is a pure function of the frames and of the verdicts delivered so far, never of the order or the number of calls. Every
/// frame of the history keeps its raw increments. A verdict that changes which axes are trusted at a past frame makes everything from that
/// frame on be integrated again by the same code. So once all verdicts are in, the attitude equals bit for bit that of a run which had them
/// at once.
///
/// Nothing is allocated after make(). Not thread-safe.
class Integrator {
public:
    /// @returns what is wrong with the settings (algorithm, history, attitude) or the cluster (kind, interval).
    static tl::expected<Integrator, std::string> make(const IntegratorSettings& settings, const geometry::SensorCluster& cluster);

    Integrator(Integrator&&) noexcept;
    Integrator& operator=(Integrator&&) noexcept;
    ~Integrator();

    /// Integrates one frame. Frames have passed the intake: identities newer than the last one, valid axes finite, interval above 0.
    /// Frames that never arrived are bridged by `accumulated` for the axes whose `missed` did not change.
    /// A frame of a newer epoch starts a new history. The rotation in between is not known, so the mode is LOST until a reset, unless the
    /// start of that epoch was stated.
    void add(const SensorFrame& frame);

    /// Any order, repeated, late, or early (before its frame). At most a bounded slice of the roll-back that it may cause is done here. The
    /// rest is done by work(), at the latest slice by slice in add().
    void apply(const FaultVerdict& verdict);

    /// One bounded slice (at most 128 frames) of a pending roll-back. @returns true while more is left.
    bool work();

    /// The attitude of the newest frame. While a roll-back is pending it follows the old track. Then the correction appears as a whole,
    /// with reset_counter + 1 if an attitude that was published has changed, and with reset_rotation = q_new o conj(q_old) at the newest
    /// published frame.
    AttitudeState state() const;

    /// state(), and from now on the newest frame counts as published: what changes it later is a reset. (Adding the next frame has the same
    /// effect.) Between add() and publish() a verdict on the newest frame changes its attitude without a reset.
    AttitudeState publish();

    /// A lane's verdict reached further back than the history: its correction is incomplete. Counts such verdicts.
    std::uint64_t history_too_short() const { return history_too_short_; }

    /// What a voted attitude put right.
    struct Mending {
        bool done = false;
        AxisMask axes = 0;  ///< their fault was in the attitude taken over before; none if that attitude was UNTRUSTED
    };

    /// The voters' output. While no attitude is known it is taken over: attitude, isolated axes and resets. The mode stays INITIALISING
    /// until the first frame after it has been integrated. From then on the attitude is marked as SEEDED, until a reset.
    ///
    /// Later it is taken over in three cases only, always from another lane and with a majority behind it unless stated otherwise:
    /// - the attitude taken over before has a fault in it that the lane's detector has found since, and the voters have excluded it;
    /// - the attitude taken over before was UNTRUSTED, and the voted one is not;
    /// - this process missed five frames or more, and the voted attitude is four times as sure (a single lane's will do), or UNTRUSTED.
    Mending on_voted(const VotedAttitude& voted);

    /// By command: the attitude at the end of this sequence is this. The frames after it are integrated again from there, so that lanes
    /// that receive the command at different frames agree. Announced as a reset; history before it is closed.
    /// @returns false where the history does not reach that frame, or it has not come yet: nothing is changed.
    bool reset(const std::array<double, 4>& attitude, std::uint64_t sequence);

    /// The description of an epoch states the attitude at the start of its sequence 0: the first frame of that epoch starts from it,
    /// without mode LOST.
    void begin_epoch(std::uint64_t epoch, const std::array<double, 4>& attitude);

    /// @returns nullptr while the parts agree with each other, otherwise what is wrong. For tests, after every call.
    const char* broken_invariant() const;

private:
    Integrator(const IntegratorSettings& settings, const geometry::SensorCluster& cluster, std::unique_ptr<const Update> update);

    void enter_epoch(std::uint64_t epoch);
    void bridge(const SensorFrame& frame);
    Record& append_record();
    void integrate_newest();
    void close_history(std::size_t count, const Standing& standing);
    Standing stated(const rotation::Quaternion& attitude) const;

    bool seed(const VotedAttitude& voted);
    bool connect_seed();
    void start_from(const VotedAttitude& voted, std::size_t first_record);
    bool mends(const VotedAttitude& voted) const;
    bool knows_better_after_absence(const VotedAttitude& voted) const;
    AxisMask faulty_in_seed() const;

    void refold();
    std::size_t refresh(std::size_t begin, std::size_t end);
    void judge_record(Record& record);
    void finish_correction();

    IntegratorSettings settings_;  ///< Never changes.
    BodyIncrement body_;  ///< Body increments from any set of the cluster's axes. Never changes, but for the solutions that it keeps.

    /// The newest frame's identity and accumulated angles. add() moves it on, and a seed may name its place before the first frame. Its
    /// next sequence is the one after the newest record.
    std::unique_ptr<FrameStream> stream_;

    /// One record per frame or gap, with the opinion in force at it. add() appends, a verdict changes opinions, a seed or a reset closes
    /// its older part. Its masks are what trust_ makes of all opinions, its standings what integration_ makes of the records.
    std::unique_ptr<History> history_;

    /// Verdicts on frames before and after the history, and what all verdicts together exclude. Changed by apply() and by a seed, and
    /// whenever a record leaves history_.
    std::unique_ptr<Trust> trust_;

    /// The update algorithm and how far it has come. Records of history_ before its cursor agree with the axes now trusted; the others wait
    /// for work().
    std::unique_ptr<Integration> integration_;

    /// Whether an attitude is known, and from where. While it is catching up, nothing is announced.
    std::unique_ptr<Start> start_;

    /// The attitude as others see it. It equals the newest standing of history_ whenever integration_ has caught up.
    std::unique_ptr<Announcement> announcement_;

    Identity verdict_applied_;             ///< The newest verdict of this epoch that apply() has received. Reset by a new epoch.
    std::uint64_t history_too_short_ = 0;  ///< Counted by refold(), when axes change at the oldest record that can be integrated again.
};

}  // namespace quorient::attitude
