#pragma once

#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/voting/voter_settings.hpp"

#include <cstdint>
#include <memory>

namespace quorient::voting {

/// What is to be published on `voter_output`.
struct Output {
    VotedAttitude attitude;
};

/// Something an operator may want to know, once; the service adds its own name and the wall clock.
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
    std::uint64_t gaps = 0;  ///< frames of which no lane's attitude arrived
    std::uint64_t duplicates = 0;
    std::uint64_t late = 0;      ///< after their frame was published (they still vouch) or older than that
    std::uint64_t foreign = 0;   ///< unknown lanes, detectors, voters, units; epochs and sequences that nobody else knows
    std::uint64_t rejected = 0;  ///< not finite or not a unit quaternion
    std::uint64_t primary_changes = 0;
    std::uint64_t resynchronised = 0;  ///< own delays above the lease
};

/// The brain of the voter process: many lanes' attitudes in, one out. The output is the primary lane's attitude, never an
/// average; the others vouch for it. The rules and their reasons are in common/voting/README.md.
///
/// Time is passed in as steady nanoseconds and must not decrease (an earlier time is taken as the latest one seen).
/// After every call, drain next_owned, next_output and next_event, in this order. Nothing is allocated after construction.
///
/// Not guaranteed: with two lanes that contradict each other it cannot tell who is right; it stays with the primary and says SINGLE.
class Voter {
public:
    /// @param settings must pass check(settings).
    explicit Voter(const VoterSettings& settings);
    ~Voter();
    Voter(Voter&&) noexcept;
    Voter& operator=(Voter&&) noexcept;

    void on_attitude(const AttitudeState& attitude, std::int64_t now_ns);
    void on_verdict(const FaultVerdict& verdict, std::int64_t now_ns);

    /// A sample seen on `voter_output`; own ones are ignored.
    void on_other_voter(const VotedAttitude& output, std::int64_t now_ns);

    /// Time passes: patience ends, lanes fall silent, a coasting output is due.
    void poll(std::int64_t now_ns);

    /// When poll must be called at the latest.
    std::int64_t next_deadline_ns() const;

    /// What is to be written to `voted`, before anything is published on `voter_output`: a voter that follows this one writes after it.
    bool next_owned(VotedAttitude& output);

    /// @returns whether there was one; the oldest first.
    bool next_output(Output& output);
    bool next_event(VoterEvent& event);

    const VoterCounters& counters() const;
    VoteLevel level() const;
    std::uint32_t primary_lane() const;  ///< lane id, 0 while there is none
    bool owns() const;                   ///< may own, and no stronger voter is fresh

    /// Whether `voted` may be owned now. Assert its liveliness only while this holds, or a better voter is kept from taking over.
    bool may_own() const;

private:
    class Brain;
    std::unique_ptr<Brain> brain_;
};

}  // namespace quorient::voting
