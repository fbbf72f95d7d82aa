#pragma once

#include "quorient/messages/codes.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"
#include "agreement.hpp"
#include "quorient/voting/voter.hpp"
#include "state_diagram.hpp"

#include <gtest/gtest.h>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace quorient::voting::test {

inline constexpr std::int64_t ms = 1'000'000;
inline constexpr std::int64_t interval = 5 * ms;
inline constexpr std::uint64_t first_epoch = 1000;

/// The rotation by an angle about an axis of the reference frame.
inline Quaternion turn(double angle_rad, int axis = 2)
{
    Quaternion q{std::cos(angle_rad / 2), 0, 0, 0};
    q[static_cast<std::size_t>(axis) + 1] = std::sin(angle_rad / 2);
    return q;
}

/// What the vehicle really does: 0.7 rad/s about body x after a tilt.
inline Quaternion truth(std::uint64_t sequence)
{
    return product(turn(0.4, 1), turn(0.7 * 0.005 * static_cast<double>(sequence + 1), 0));
}

inline VoterSettings settings_of(std::size_t lanes, std::vector<std::uint32_t> voters = {}, std::uint32_t voter = 1)
{
    VoterSettings settings;
    settings.unit = 7;
    settings.voter = voter;
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
        settings.lanes.push_back({lane + 1, lane + 101, std::string(1, static_cast<char>('a' + lane))});
    settings.voters = std::move(voters);
    settings.interval_s = 0.005;
    settings.lease_s = 0.05;
    return settings;
}

inline AttitudeState sample_of(std::size_t lane, std::uint64_t sequence, std::uint64_t epoch = first_epoch)
{
    AttitudeState sample;
    sample.epoch = epoch;
    sample.sequence = sequence;
    sample.sample_time_ns = static_cast<std::int64_t>(sequence + 1) * interval;
    sample.attitude = truth(sequence);
    sample.rate_rad_s = {0.7, 0, 0};
    sample.angle_sigma_rad = 1e-5;
    sample.excluded_from = Exclusions{};
    sample.unit = 7;
    sample.lane = static_cast<std::uint32_t>(lane) + 1;
    sample.used_mask = 0x3f;
    sample.mode = octet(AttitudeMode::normal);
    return sample;
}

/// The same sample, off by a rotation of the reference frame.
inline AttitudeState moved(AttitudeState sample, double angle_rad)
{
    sample.attitude = product(turn(angle_rad), sample.attitude);
    return sample;
}

inline AttitudeState isolating(AttitudeState sample, AxisMask axes)
{
    sample.isolated_mask = axes;
    sample.used_mask &= ~axes;
    return sample;
}

/// An axis that the lane's detector leaves out from this frame on, until it is confirmed or agrees again.
inline AttitudeState leaving_out(AttitudeState sample, AxisMask axes, std::uint64_t from)
{
    sample.excluded_from.exclude(axes, from);
    sample.used_mask &= ~axes;
    return sample;
}

/// What another voter publishes.
inline VotedAttitude output_by(std::uint32_t voter, std::uint64_t sequence, std::uint64_t output_sequence)
{
    VotedAttitude output;
    output.epoch = first_epoch;
    output.sequence = sequence;
    output.output_sequence = output_sequence;
    output.attitude = truth(sequence);
    output.unit = 7;
    output.voter = voter;
    output.primary_lane = 1;
    output.vouching_mask = 7;
    return output;
}

inline FaultVerdict verdict_of(std::size_t lane, std::uint64_t sequence, VerdictState state = VerdictState::healthy, AxisMask axes = 0)
{
    FaultVerdict verdict;
    verdict.epoch = first_epoch;
    verdict.sequence = sequence;
    verdict.unit = 7;
    verdict.detector = static_cast<std::uint32_t>(lane) + 101;
    verdict.state = octet(state);
    verdict.detectable_remaining = 2;
    if (state == VerdictState::suspect) verdict.suspect_mask = axes;
    if (state == VerdictState::isolated) verdict.isolated_mask = axes;
    if (state == VerdictState::isolated || state == VerdictState::provisional) verdict.excluded_from.exclude(axes, sequence);
    return verdict;
}

/// The states that a voter came through, as others see them: after each call.
class StatesSeen {
public:
    using Arrow = ::quorient::test::Arrow;

    /// @returns false for a change that common/voting/README.md does not draw.
    bool see(VoterState state)
    {
        if (!state_ || *state_ == state) {
            state_ = state;
            return true;
        }
        const Arrow arrow{to_string(*state_), to_string(state)};
        state_ = state;
        arrows_.insert(arrow);
        return drawn().contains(arrow);
    }

    const std::set<Arrow>& arrows() const { return arrows_; }

    static const std::set<Arrow>& drawn()
    {
        static const std::set<Arrow> arrows = ::quorient::test::state_diagram(QUORIENT_SOURCE_DIR "/common/voting/README.md");
        return arrows;
    }

private:
    std::optional<VoterState> state_;
    std::set<Arrow> arrows_;
};

/// A voter, a clock, and everything that came out.
class Scene {
public:
    explicit Scene(std::size_t lane_count = 3) : Scene(settings_of(lane_count)) {}
    explicit Scene(const VoterSettings& settings, std::int64_t start_ns = 0) : lanes(settings.lanes.size()), voter(settings), now(start_ns)
    {
        voter.poll(now);
        collect();
    }

    /// Time passes; the voter is polled whenever it asked for it.
    void until(std::int64_t time_ns)
    {
        while (voter.next_deadline_ns() <= time_ns) {
            now = std::max(now, voter.next_deadline_ns());
            voter.poll(now);
            collect();
        }
        now = std::max(now, time_ns);
    }

    /// The process does not run in between, whatever the voter asked for.
    void stopped_until(std::int64_t time_ns)
    {
        now = time_ns;
        voter.poll(now);
        collect();
    }

    void at(std::int64_t time_ns, const AttitudeState& sample)
    {
        until(time_ns);
        voter.on_attitude(sample, now);
        collect();
    }

    void at(std::int64_t time_ns, const FaultVerdict& verdict)
    {
        until(time_ns);
        voter.on_verdict(verdict, now);
        collect();
    }

    void at(std::int64_t time_ns, const VotedAttitude& output)
    {
        until(time_ns);
        voter.on_other_voter(output, now);
        collect();
    }

    static std::int64_t time_of(std::uint64_t sequence) { return static_cast<std::int64_t>(sequence + 1) * interval; }

    /// Frames in which every lane that `change` does not leave out delivers, 0.1 ms after one another.
    template <class Change>
    void frames(std::uint64_t first, std::uint64_t last, Change&& change)
    {
        for (std::uint64_t sequence = first; sequence <= last; ++sequence) {
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                AttitudeState sample = sample_of(lane, sequence);
                if (change(lane, sample)) at(time_of(sequence) + static_cast<std::int64_t>(lane) * ms / 10, sample);
            }
        }
    }

    void frames(std::uint64_t first, std::uint64_t last)
    {
        frames(first, last, [](std::size_t, AttitudeState&) { return true; });
    }

    void collect()
    {
        if (const char* broken = voter.broken_invariant()) ADD_FAILURE() << broken << ", at " << now << " ns";
        EXPECT_TRUE(states.see(voter.state())) << "a change to " << to_string(voter.state()) << " that is not drawn";
        VotedAttitude written;
        while (voter.next_owned(written, now)) owned.push_back(written);
        VotedAttitude output;
        while (voter.next_output(output)) {
            outputs.push_back(output);
            published_ns.push_back(now);
        }
        VoterEvent event;
        while (voter.next_event(event)) events.push_back(event);
    }

    const VotedAttitude& last() const { return outputs.back(); }

    std::size_t count(EventCode code) const
    {
        std::size_t found = 0;
        for (const VoterEvent& event : events) found += event.code == code ? 1 : 0;
        return found;
    }

    bool excluded(std::size_t lane) const { return (last().excluded_mask >> lane & 1U) != 0; }
    LaneExclusion why(std::size_t lane) const { return static_cast<LaneExclusion>(last().excluded_why[lane]); }
    double error_rad() const { return angle_between(last().attitude, truth(last().sequence)); }

    std::size_t lanes;
    Voter voter;
    std::int64_t now;
    StatesSeen states;
    std::vector<VotedAttitude> outputs;
    std::vector<VotedAttitude> owned;  ///< written to `voted`
    std::vector<std::int64_t> published_ns;
    std::vector<VoterEvent> events;
};

}  // namespace quorient::voting::test
