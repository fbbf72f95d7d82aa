#pragma once

#include "quorient/evaluation/fault_spells.hpp"
#include "quorient/evaluation/undecided_spells.hpp"
#include "quorient/attitude/integrator.hpp"
#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/truth_state.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/system/system.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace quorient::evaluation {

/// Angle errors against truth over a run [rad].
struct Errors {
    std::uint64_t compared = 0;
    double largest_rad = 0;
    double final_rad = 0;
    Identity final_identity;

    void add(Identity identity, double error_rad);
};

struct LaneRecord {
    std::string name;
    Vendor vendor = Vendor::unknown;
    FaultVerdict verdict;
    FaultDiagnosis diagnosis;  ///< the latest
    AttitudeState attitude;
    bool received = false;
    std::optional<Identity> isolated_at;  ///< first verdict that isolated anything after the truth's fault began
    AxisMask isolated_first = 0;
    AxisMask isolated_ever = 0;
    AxisMask triad_after = 0;  ///< axes in use after the first isolation
    std::uint64_t verdicts = 0;
    std::uint64_t suspicious = 0;  ///< verdicts that were SUSPECT, AMBIGUOUS or BLIND
    Spells isolated;
    UndecidedSpells undecided;
    std::uint64_t frames = 0;
    std::uint64_t largest_roll_back = 0;
    Errors errors;
};

struct VotedRecord {
    VotedAttitude latest;
    bool received = false;
    VoteLevel frame_level = VoteLevel::unknown;  ///< the level at the latest attitude that came from a frame, neither held nor lost
    std::uint64_t frames = 0;      ///< distinct identities
    std::uint64_t disordered = 0;  ///< output_sequence that did not increase, of one voter
    Errors errors;
};

/// Whether an integrator of the observer's own runs along without roll-back, for comparison.
enum class Shadow { on, off };

/// Compares the messages of a system with the simulator's truth. Input comes from a live bus or from a replay; clock and DDS are unknown
/// here.
class RunObserver {
public:
    explicit RunObserver(const system::System& system, Shadow shadow = Shadow::on);

    void on_description(const ClusterDescription& description);
    void on_frame(const SensorFrame& frame);
    void on_truth(const TruthState& truth);
    void on_verdict(const FaultVerdict& verdict);
    void on_diagnosis(const FaultDiagnosis& diagnosis);
    void on_attitude(const AttitudeState& attitude);
    void on_voted(const VotedAttitude& voted);
    /// The publisher has ended in order: the level that falls behind its last frame is no fault.
    void on_source_ended() { source_ended_ = true; }

    /// Called with each error of voted() and without_rollback() that is found from now on, and with the truth that it was found with.
    using Watch = std::function<void(const Errors& of, const TruthState& truth, double error_rad)>;
    void watch_errors(Watch watch) { watch_ = std::move(watch); }

    const std::vector<LaneRecord>& lanes() const { return lanes_; }
    const VotedRecord& voted() const { return voted_; }

    /// The level at the end of the run: at its last frame where the source ended in order, else now.
    VoteLevel final_level() const;

    /// Attitude of the first lane's axes if verdicts acted only from their own frame on.
    const Errors& without_rollback() const { return without_rollback_; }

    std::optional<Identity> fault_began() const { return fault_began_; }
    std::optional<Identity> fault_ended() const { return fault_ended_; }
    AxisMask faulty() const { return faulty_; }
    const Spells& faults() const { return faults_; }
    std::uint64_t truth_frames() const { return truth_frames_; }
    Identity newest_truth() const { return newest_truth_; }
    const std::optional<ClusterDescription>& description() const { return description_; }
    /// What an operator calls these axes; their numbers before the description is known.
    std::string names_of(AxisMask axes) const;
    double time_s(Identity identity) const;

    /// Frames from the fault's first to the lane's isolation, counting both ends' difference.
    std::optional<std::uint64_t> frames_to_isolation(const LaneRecord& lane) const;

    /// Voted identities that never came, up to the newest truth.
    std::uint64_t missing_voted() const;

private:
    /// A fault may touch no value in a frame (a scale fault of a value that passes 0) and still last.
    static constexpr double longest_pause_s = 0.2;

    /// An attitude whose truth has not arrived yet.
    struct Waiting {
        Identity identity;
        std::array<double, 4> attitude;
        Errors* errors;
    };

    /// The truth of a later epoch while the present one may still go on. Services ignore a second publisher until the first one is silent; so
    /// does the observer, which knows no clock: until as many frames of the later epoch came as last for that silence, and none of the present.
    struct LaterEpoch {
        std::vector<TruthState> since_present;  ///< since the present epoch's newest truth
        bool overlaps = false;                  ///< came between truths of the present epoch: a second publisher, and no restart
    };

    void count(const TruthState& truth);
    void await(const TruthState& truth);
    double interval_s() const { return description_ ? description_->interval_s : system_.interval_s; }
    void compare(Identity identity, const std::array<double, 4>& attitude, Errors& errors);
    void compare_waiting();
    LaneRecord* lane_of(std::uint32_t lane);
    LaneRecord* lane_of_detector(std::uint32_t detector);

    const system::System& system_;
    Shadow shadow_wanted_;
    std::vector<LaneRecord> lanes_;
    VotedRecord voted_;
    Errors without_rollback_;
    Watch watch_;
    std::optional<attitude::Integrator> shadow_;
    std::vector<FaultVerdict> early_verdicts_;  ///< for shadow_, which has not received their frames: it would leave an axis out from its onset
    Identity newest_frame_;                     ///< that shadow_ has received
    std::optional<ClusterDescription> description_;
    std::map<std::uint64_t, LaterEpoch> later_;                                   // by epoch
    std::unordered_map<std::uint64_t, TruthState> truth_;                         // by sequence, newest epoch only
    std::map<std::uint64_t, std::unordered_set<std::uint64_t>> voted_sequences_;  // by epoch, from the newest truth's on
    std::map<std::uint32_t, std::uint64_t> output_sequences_;                     // by voter
    std::vector<Waiting> waiting_;
    std::optional<Identity> fault_began_;
    std::optional<Identity> fault_ended_;
    bool source_ended_ = false;
    AxisMask faulty_ = 0;
    Spells faults_{longest_pause_s};
    std::uint64_t truth_frames_ = 0;
    Identity newest_truth_;
};

}  // namespace quorient::evaluation
