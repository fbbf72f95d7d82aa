#pragma once

#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/stream_place.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <array>
#include <cstdint>

namespace quorient::detector {

/// Whose exclusions a detector adopts. The diagram is in services/detector/README.md; a test compares both.
enum class AdoptionState : std::uint8_t {
    /// It has judged no frame since it started: its method is warming up. It adopts all that its lane's integrator still excludes, and all
    /// that a majority of lanes has isolated. It ends with the first frame that is judged (watching, or missed_frames if frames came before
    /// the first one here). An order to trust axes again ends it too (watching): what others still exclude may be older than the order.
    restarted,

    /// It judges every frame itself and adopts nothing. It ends when frames are missing before the one that came (missed_frames).
    watching,

    /// Frames were missing. An axis whose fault began in them has no onset here, and four axes alone cannot name it any more. So it adopts
    /// what a majority of lanes has isolated since those frames. It ends by an order to trust axes again, and with a new epoch that is
    /// received from its first frame on (watching).
    missed_frames,
};

inline constexpr std::array all_adoption_states{AdoptionState::restarted, AdoptionState::watching, AdoptionState::missed_frames};

const char* to_string(AdoptionState state);

/// What a detector takes over from processes that kept running while it did not: which isolations, and until when. Axes that are left out
/// provisionally are never taken over: they return by themselves.
class Adoption {
public:
    /// @param warm_up_frames  a method needs so many frames before it can see a fault begin
    explicit Adoption(std::uint64_t warm_up_frames) : warm_up_frames_(warm_up_frames) {}

    AdoptionState state() const { return state_; }

    /// This frame is about to be judged. It is newer than all before.
    void on_frame(Identity frame);

    /// The verdict on that frame.
    void on_verdict(const FaultVerdict& verdict);

    /// An order to trust axes again. @returns whether it kept this detector from adopting what others exclude.
    bool on_readmission();

    /// What the lane's own integrator excludes, and what a majority of lanes stands behind. These are kept while the state is `restarted`.
    /// @returns whether anything is to be adopted because of it.
    bool on_lane(const AttitudeState& attitude);
    bool on_voted(const VotedAttitude& voted);

    /// All that is kept, in sequences of this epoch.
    Exclusions kept(std::uint64_t epoch) const;

    /// The isolations of a voted attitude of this epoch whose fault began in frames that were missing, without the axes in `isolated`.
    Exclusions missed(const VotedAttitude& voted, AxisMask isolated) const;

private:
    struct Kept {
        std::uint64_t epoch = 0;
        Exclusions exclusions;
    };

    void stop_adopting_all();

    AdoptionState state_ = AdoptionState::restarted;
    std::uint64_t warm_up_frames_;
    Kept of_lane_;                     // its newest exclusions; of no use once the state is not `restarted`
    Kept of_voters_;                   // likewise
    StreamPlace place_;                // behind the newest frame
    std::uint64_t first_missing_ = 0;  // frames [first_missing_, end_missing_) of its epoch never came; end_missing_ 0 where all came
    std::uint64_t end_missing_ = 0;
};

}  // namespace quorient::detector
