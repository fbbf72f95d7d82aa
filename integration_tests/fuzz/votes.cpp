#include "bytes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/voting/voter.hpp"
#include "require.hpp"
#include "targets.hpp"

#include <cmath>

namespace quorient::fuzz {

namespace {

constexpr std::int64_t interval_ns = 5'000'000;

voting::VoterSettings settings()
{
    voting::VoterSettings made;
    made.unit = made.voter = 1;
    made.lanes = {{1, 1, "a"}, {2, 2, "b"}, {3, 3, "c"}};
    made.voters = {1, 2};
    made.interval_s = 0.005;
    return made;
}

}  // namespace

void votes(const std::uint8_t* data, std::size_t size)
{
    Bytes bytes{data, size};
    voting::Voter voter{settings()};
    std::int64_t now = 0;
    std::uint64_t sequence = 0, last_output = 0;
    const auto drain = [&] {
        VotedAttitude owned;
        while (voter.next_owned(owned, now)) continue;
        VotedAttitude output;
        while (voter.next_output(output)) {
            REQUIRE(output.output_sequence > last_output);
            last_output = output.output_sequence;
            double squared_norm = 0;
            for (const double component : output.attitude) squared_norm += component * component;
            REQUIRE(std::abs(std::sqrt(squared_norm) - 1) < 1e-6);
        }
        voting::VoterEvent event;
        while (voter.next_event(event)) continue;
    };
    while (!bytes.empty()) {
        const auto what = bytes.below(32);
        now += what == 0 ? 1'000'000'000 : interval_ns / 3;
        const auto lane = 1 + bytes.below(3);
        AttitudeState attitude;
        attitude.epoch = 1;
        attitude.sequence = sequence;
        attitude.unit = 1;
        attitude.lane = lane;
        attitude.mode = octet(AttitudeMode::normal);
        attitude.angle_sigma_rad = 1e-6;
        attitude.used_mask = 0xF;
        attitude.excluded_from.fill(never);
        FaultVerdict verdict;
        verdict.epoch = 1;
        verdict.sequence = sequence;
        verdict.unit = 1;
        verdict.detector = lane;
        verdict.state = octet(VerdictState::healthy);
        VotedAttitude other;
        other.epoch = 1;
        other.sequence = sequence;
        other.unit = 1;
        other.voter = 2;
        other.output_sequence = last_output;
        if (what < 12) {
            spoil_members(attitude, bytes);
            spoil_members(verdict, bytes);
            spoil_members(other, bytes);
        }
        voter.on_verdict(verdict, now);
        drain();
        voter.on_attitude(attitude, now);
        drain();
        // No voter has put out more than may follow: an output_sequence at its end would leave none to come.
        if (bytes.below(8) == 0 && other.output_sequence < never / 2) voter.on_other_voter(other, now);
        drain();
        voter.poll(now);
        drain();
        if (bytes.below(3) == 0) ++sequence;
    }
}

}  // namespace quorient::fuzz
