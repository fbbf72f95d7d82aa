#include "adoption.hpp"

#include "quorient/messages/meaning.hpp"
#include "state_diagram.hpp"

#include <gtest/gtest.h>
#include <functional>
#include <vector>

namespace quorient::detector {
namespace {

constexpr std::uint64_t warm_up = 10;

FaultVerdict verdict(VerdictState state)
{
    FaultVerdict verdict;
    verdict.state = octet(state);
    return verdict;
}

VotedAttitude isolating(std::uint64_t epoch, AxisMask axes, std::uint64_t from)
{
    VotedAttitude voted;
    voted.epoch = epoch;
    voted.level = octet(VoteLevel::degraded);
    voted.isolated_mask = axes;
    voted.excluded_from.exclude(axes, from);
    return voted;
}

/// An adoption that has come to this state, at frame 20 of epoch 1. @param late  whether frames came before its first one
Adoption in(AdoptionState state, bool late)
{
    Adoption adoption(warm_up);
    if (!late) adoption.on_frame({1, 0});
    for (std::uint64_t sequence = late ? 11 : 1; sequence <= 20; ++sequence) adoption.on_frame({1, sequence});
    if (state == AdoptionState::restarted) return adoption;
    adoption.on_verdict(verdict(VerdictState::healthy));
    if (state == AdoptionState::watching && late) adoption.on_readmission();
    if (state == AdoptionState::missed_frames && !late) adoption.on_frame({1, 23});
    EXPECT_EQ(adoption.state(), state);
    return adoption;
}

TEST(Adoption, changes_its_state_as_the_diagram_in_the_readme_shows)
{
    const std::vector<std::function<void(Adoption&)>> events{
        [](Adoption& adoption) {
            adoption.on_frame({1, 24});
        },
        [](Adoption& adoption) {
            adoption.on_frame({1, 90});
        },
        [](Adoption& adoption) {
            adoption.on_frame({2, 0});
        },
        [](Adoption& adoption) {
            adoption.on_frame({2, 7});
        },
        [](Adoption& adoption) { adoption.on_verdict(verdict(VerdictState::warming_up)); },
        [](Adoption& adoption) { adoption.on_verdict(verdict(VerdictState::healthy)); },
        [](Adoption& adoption) { adoption.on_readmission(); },
        [](Adoption& adoption) { adoption.on_voted(isolating(1, axis_bit(1), 5)); },
    };
    std::set<test::Arrow> arrows;
    for (const AdoptionState from : all_adoption_states) {
        for (const bool late : {false, true}) {
            for (const auto& event : events) {
                Adoption adoption = in(from, late);
                event(adoption);
                if (adoption.state() != from) arrows.emplace(to_string(from), to_string(adoption.state()));
            }
        }
    }
    EXPECT_EQ(arrows, test::state_diagram(QUORIENT_SOURCE_DIR "/services/detector/README.md"));
}

TEST(Adoption, keeps_the_earlier_of_two_onsets_until_the_first_judgement)
{
    Adoption adoption = in(AdoptionState::restarted, true);
    AttitudeState lane;
    lane.epoch = 1;
    lane.isolated_mask = axis_bit(1);
    lane.excluded_from.exclude(axis_bit(1), 9);
    EXPECT_TRUE(adoption.on_lane(lane));
    EXPECT_TRUE(adoption.on_voted(isolating(1, axis_bit(1) | axis_bit(2), 7)));
    EXPECT_EQ(adoption.kept(1)[1], 7u);
    EXPECT_EQ(adoption.kept(1)[2], 7u);
    EXPECT_EQ(adoption.kept(2)[1], 0u) << "in another epoch the axis is faulty from its first frame on";
    adoption.on_verdict(verdict(VerdictState::healthy));
    EXPECT_EQ(adoption.kept(1).mask(), 0u);
}

TEST(Adoption, never_takes_over_what_is_left_out_provisionally)
{
    VotedAttitude voted = isolating(1, axis_bit(1), 18);
    voted.isolated_mask = 0;
    EXPECT_FALSE(in(AdoptionState::restarted, true).on_voted(voted));
    EXPECT_EQ(in(AdoptionState::missed_frames, false).missed(voted, 0).mask(), 0u);
    voted.isolated_mask = axis_bit(1);
    EXPECT_EQ(in(AdoptionState::missed_frames, false).missed(voted, 0).mask(), axis_bit(1));
}

TEST(Adoption, of_missed_frames_asks_for_a_majority_and_for_a_fault_that_began_there)
{
    const Adoption adoption = in(AdoptionState::missed_frames, false);  // 21 and 22 are missing
    EXPECT_EQ(adoption.missed(isolating(1, axis_bit(1), 11), 0).mask(), axis_bit(1)) << "the method was warming up for ten frames";
    EXPECT_EQ(adoption.missed(isolating(1, axis_bit(1), 10), 0).mask(), 0u);
    EXPECT_EQ(adoption.missed(isolating(1, axis_bit(1), 32), 0).mask(), axis_bit(1));
    EXPECT_EQ(adoption.missed(isolating(1, axis_bit(1), 33), 0).mask(), 0u);
    EXPECT_EQ(adoption.missed(isolating(1, axis_bit(1), 21), axis_bit(1)).mask(), 0u) << "it has isolated that axis itself";
    EXPECT_EQ(adoption.missed(isolating(2, axis_bit(1), 21), 0).mask(), 0u) << "of another epoch";
    VotedAttitude single = isolating(1, axis_bit(1), 21);
    single.level = octet(VoteLevel::single);
    EXPECT_EQ(adoption.missed(single, 0).mask(), 0u);
}

}  // namespace
}  // namespace quorient::detector
