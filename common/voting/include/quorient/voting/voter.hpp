#pragma once

#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/voting/voter_settings.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

namespace quorient::voting {

/// An event for an operator; the service adds its own name and the wall clock.
struct VoterEvent {
    EventCode code = EventCode::unknown;
    Severity severity = Severity::unknown;
    Identity identity;
    AxisMask axes = 0;
    std::uint32_t lane = 0;  ///< lane id, 0 where the event is about none
    Name<160> text{};
};

struct VoterCounters {
    std::uint64_t received = 0;  ///< attitudes of known lanes
    std::uint64_t published = 0;
    std::uint64_t gaps = 0;  ///< frames that neither this voter nor another one published
    std::uint64_t duplicates = 0;
    std::uint64_t late = 0;      ///< after their frame's patience had ended (they still vouch) or older than that
    std::uint64_t foreign = 0;   ///< unknown lanes, detectors, voters, units; epochs and sequences that no other lane knows
    std::uint64_t rejected = 0;  ///< not finite or not a unit quaternion
    std::uint64_t primary_changes = 0;
    std::uint64_t absences = 0;  ///< own delays so long that another voter may have taken over
};

/// What a voter does with `voter_output` and `voted`. The transitions are drawn in common/voting/README.md.
enum class VoterState : std::uint8_t {
    listening,  ///< Publishes nothing. Left when it knows where the stream is: after a start, or after its queues are read again.
    waiting,    ///< Publishes on voter_output and may not write `voted`. Left after enough good frames.
    following,  ///< May write `voted`, each frame after a stronger voter. Left when that one is silent.
    owning,     ///< May write `voted`; no stronger voter is fresh.
    cut_off,    ///< Repeats its last attitude while another voter goes on, and leaves `voted` to that one. Left when its lanes deliver again.
};

inline constexpr std::array voter_states{VoterState::listening, VoterState::waiting, VoterState::following, VoterState::owning,
                                         VoterState::cut_off};

std::string_view to_string(VoterState state);

class Frames;
class Listening;
class Narrator;
class OtherVoters;
class Output;
class OwnedStream;

/// The brain of the voter process: many lanes' attitudes in, one out. The output is the primary lane's attitude, never an average; the
/// others vouch for it. The rules and their reasons are in docs/methods/voting.md.
///
/// Time is passed in as steady nanoseconds and must not decrease (an earlier time is taken as the latest one seen).
/// After every call, drain next_owned, next_output and next_event, in this order. Nothing is allocated after construction.
///
/// Not guaranteed: with two lanes that contradict each other it cannot tell which is right; it stays with the primary and reports SINGLE.
class Voter {
public:
    /// @param settings must pass check(settings).
    explicit Voter(const VoterSettings& settings);
    ~Voter();
    Voter(Voter&&) noexcept;
    Voter& operator=(Voter&&) noexcept;

    void on_attitude(const AttitudeState& attitude, std::int64_t now_ns);
    void on_verdict(const FaultVerdict& verdict, std::int64_t now_ns);

    /// A sample received on `voter_output`; own ones are ignored.
    void on_other_voter(const VotedAttitude& output, std::int64_t now_ns);

    /// Time passes: patience ends, lanes fall silent, a coasting output is due.
    void poll(std::int64_t now_ns);

    /// Frames come at the pace of one in so many, since this voter or its lanes are overloaded; 1 = all of them come. Then the voter waits
    /// and lets lanes be silent for so many times longer, and gives out frames in poll alone: the newest one that is ready, none before it.
    void keep_pace(unsigned one_in);

    /// When poll must be called at the latest.
    std::int64_t next_deadline_ns() const { return promised_ns_; }

    /// What is to be written to `voted`, before anything is published on `voter_output`: a voter that follows this one writes after it.
    /// @param now_ns  the time just before the write: this voter may have been away since it decided, and another one may own `voted`
    bool next_owned(VotedAttitude& output, std::int64_t now_ns);

    /// What is to be published on `voter_output`. @returns whether there was one; the oldest first.
    bool next_output(VotedAttitude& output);
    bool next_event(VoterEvent& event);

    const VoterCounters& counters() const { return *counters_; }
    VoteLevel level() const;
    std::uint64_t epoch() const;         ///< that the frames belong to, 0 before the first one
    std::uint32_t primary_lane() const;  ///< lane id, 0 while there is none
    VoterState state() const { return state_; }
    bool owns() const { return state_ == VoterState::owning; }

    /// Whether `voted` may be owned now. Assert its liveliness only while this holds, or a better voter is kept from taking over.
    bool may_own() const { return state_ == VoterState::owning || state_ == VoterState::following; }

    /// @returns nullptr while the parts agree with each other, otherwise what is wrong. For tests, after every call.
    const char* broken_invariant() const;

private:
    void notice(std::int64_t now_ns);
    void go_on(bool publishes);
    void end_listening();
    bool nobody_took_over() const;
    void publish_what_is_ready(bool at_once);
    bool is_ready(std::uint64_t sequence) const;
    bool is_overtaken(std::uint64_t sequence) const;
    bool follow_others_to(Identity identity);
    void adopt(const VotedAttitude& output);
    void consider_state();
    void plan();

    std::unique_ptr<const VoterSettings> settings_;  ///< As given; the parts refer to it.
    std::unique_ptr<VoterCounters> counters_;        ///< Counted by this class and by the parts.
    std::unique_ptr<Narrator> narrator_;             ///< Events that next_event() hands out; the parts add theirs.
    std::unique_ptr<OtherVoters> others_;            ///< What is known of the other voters.
    std::unique_ptr<Frames> frames_;                 ///< What the lanes deliver.
    std::unique_ptr<OwnedStream> owned_;             ///< What is written to `voted`.
    std::unique_ptr<Output> output_;                 ///< What is published; refers to the parts above.
    std::unique_ptr<Listening> listening_;           ///< When state_ ceases to be listening.
    VoterState state_ = VoterState::waiting;         ///< Changed by notice() and consider_state() alone.
    std::optional<std::int64_t> now_ns_;             ///< The latest time passed in; none before the first call.
    std::int64_t promised_ns_;                       ///< When poll was asked for. Later than now_ns_ after every call.
    std::optional<std::int64_t> published_ns_;       ///< When a frame was last published; none after a repetition or an absence.
    unsigned one_in_ = 1;                            ///< As set by keep_pace().
    bool owned_before_ = false;                      ///< While listening: it owned `voted` before it was delayed.
    Identity missed_until_;                          ///< After listening: frames up to this one may have been published by another voter.
};

}  // namespace quorient::voting
