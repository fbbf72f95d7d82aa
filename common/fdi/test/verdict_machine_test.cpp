#include "verdict/verdict_machine.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

namespace quorient::fdi {
namespace {

constexpr AxisMask axis_1 = 0b0010;
constexpr AxisMask axis_2 = 0b0100;

Assessment healthy()
{
    return {.outcome = Outcome::healthy};
}

Assessment naming(AxisMask axes)
{
    return {.outcome = Outcome::isolated, .isolated = axes};
}

Assessment explained_by(std::initializer_list<AxisMask> sets, Outcome outcome = Outcome::ambiguous)
{
    Assessment assessment{.outcome = outcome};
    for (const AxisMask set : sets) assessment.add_candidate(set);
    return assessment;
}

/// A machine past its warm-up, fed frame by frame.
class VerdictMachineTest : public ::testing::Test {
protected:
    VerdictMachineTest() { feed(healthy(), settings_.warm_up_frames + 10); }

    const FaultVerdict& feed(const Assessment& assessment, unsigned frames = 1, AxisMask broken = 0)
    {
        for (unsigned i = 0; i < frames; ++i) machine_.update({1, next_++}, assessment, broken);
        return machine_.verdict();
    }

    VerdictState state() const { return state_of(machine_.verdict()); }

    VerdictSettings settings_;
    VerdictMachine machine_ = VerdictMachine::make(settings_, 6).value();
    std::uint64_t next_ = 0;
};

TEST_F(VerdictMachineTest, stays_healthy_without_suspicion)
{
    EXPECT_EQ(state(), VerdictState::healthy);
    EXPECT_EQ(machine_.verdict().working_mask, 0b111111U);
    EXPECT_EQ(machine_.verdict().suspect_mask, 0U);
}

TEST_F(VerdictMachineTest, suspects_the_named_axis_at_the_first_frame_and_isolates_it_at_the_second)
{
    feed(naming(axis_1));
    EXPECT_EQ(state(), VerdictState::suspect);
    EXPECT_EQ(machine_.verdict().suspect_mask, axis_1);
    EXPECT_EQ(machine_.verdict().isolated_mask, 0U);

    feed(naming(axis_1));
    EXPECT_EQ(state(), VerdictState::isolated);
    EXPECT_EQ(machine_.verdict().isolated_mask, axis_1);
    EXPECT_EQ(machine_.verdict().suspect_mask, 0U);
}

TEST_F(VerdictMachineTest, lets_a_single_frame_pass)
{
    feed(naming(axis_1));
    feed(healthy(), 3);
    EXPECT_EQ(state(), VerdictState::healthy);
    feed(naming(axis_1));
    EXPECT_EQ(state(), VerdictState::suspect);
}

TEST_F(VerdictMachineTest, confirms_over_one_healthy_frame_within_the_window)
{
    feed(naming(axis_1));
    feed(healthy());
    EXPECT_EQ(feed(naming(axis_1)).isolated_mask, axis_1);
}

TEST_F(VerdictMachineTest, places_the_onset_a_guard_before_the_first_suspicious_frame)
{
    const std::uint64_t first = next_;
    feed(naming(axis_1), 2);
    EXPECT_EQ(machine_.verdict().excluded_from[1], first - settings_.onset_guard_frames);
    EXPECT_EQ(machine_.verdict().excluded_from[2], never);
}

TEST_F(VerdictMachineTest, places_the_onset_after_the_last_healthy_frame_before_a_gap)
{
    const std::uint64_t lost = next_;
    next_ += 5;
    feed(naming(axis_1), 2);
    EXPECT_EQ(machine_.verdict().excluded_from[1], lost - settings_.onset_guard_frames);
}

TEST_F(VerdictMachineTest, takes_the_method_s_own_onset_where_it_is_earlier)
{
    Assessment late = naming(axis_1);
    late.onset = 7;
    feed(late, 2);
    EXPECT_EQ(machine_.verdict().excluded_from[1], 7 - settings_.onset_guard_frames);
}

TEST_F(VerdictMachineTest, keeps_an_isolation_latched_while_the_axis_looks_healthy)
{
    feed(naming(axis_1), 2);
    const auto onset = machine_.verdict().excluded_from[1];
    feed(healthy(), 1000);
    EXPECT_EQ(state(), VerdictState::isolated);
    EXPECT_EQ(machine_.verdict().isolated_mask, axis_1);
    EXPECT_EQ(machine_.verdict().excluded_from[1], onset);
}

TEST_F(VerdictMachineTest, names_candidates_and_no_culprit_while_a_rival_of_equal_size_explains_the_data)
{
    Assessment rivalled = naming(axis_1);
    rivalled.add_candidate(axis_2);
    feed(rivalled, 50);
    EXPECT_EQ(state(), VerdictState::ambiguous);
    EXPECT_EQ(machine_.verdict().isolated_mask, 0U);
    ASSERT_EQ(machine_.verdict().candidate_count, 2);
    EXPECT_EQ(machine_.verdict().candidate_set[0], axis_1);
    EXPECT_EQ(machine_.verdict().candidate_set[1], axis_2);
}

TEST_F(VerdictMachineTest, isolates_although_a_larger_set_would_explain_the_data_too)
{
    Assessment named = naming(axis_1);
    named.add_candidate(axis_1 | axis_2);
    EXPECT_EQ(feed(named, 2).isolated_mask, axis_1);
}

TEST_F(VerdictMachineTest, is_ambiguous_while_the_frames_contradict_each_other)
{
    feed(naming(axis_1));
    feed(naming(axis_2));
    EXPECT_EQ(state(), VerdictState::ambiguous);
    EXPECT_EQ(machine_.verdict().candidate_count, 2);
    EXPECT_EQ(feed(naming(axis_2)).isolated_mask, axis_2);
}

TEST_F(VerdictMachineTest, names_the_candidates_of_an_unattributable_fault_and_forgets_them_when_it_passes)
{
    feed(explained_by({axis_1, axis_2}));
    EXPECT_EQ(state(), VerdictState::suspect);
    feed(explained_by({axis_1, axis_2}), 30);
    EXPECT_EQ(state(), VerdictState::ambiguous);
    EXPECT_EQ(machine_.verdict().suspect_mask, 0U);
    feed(healthy(), 3);
    EXPECT_EQ(state(), VerdictState::healthy);
    EXPECT_EQ(machine_.verdict().candidate_count, 0);
}

TEST_F(VerdictMachineTest, is_blind_only_after_confirmation)
{
    feed({.outcome = Outcome::refused});
    EXPECT_EQ(state(), VerdictState::suspect);
    feed({.outcome = Outcome::blind});
    EXPECT_EQ(state(), VerdictState::blind);
    feed(healthy(), 3);
    EXPECT_EQ(state(), VerdictState::healthy);
}

TEST_F(VerdictMachineTest, keeps_exclusions_through_blindness_warm_up_and_gaps)
{
    feed(naming(axis_1), 2);
    feed({.outcome = Outcome::blind}, 5);
    EXPECT_EQ(machine_.verdict().isolated_mask, axis_1);
    feed({.outcome = Outcome::warming_up}, 5);
    EXPECT_EQ(machine_.verdict().isolated_mask, axis_1);
    next_ += 1000;
    EXPECT_EQ(feed(healthy()).isolated_mask, axis_1);
}

TEST_F(VerdictMachineTest, excludes_from_the_first_sequence_of_a_new_epoch)
{
    feed(naming(axis_1), 2);
    machine_.update({2, 0}, healthy());
    EXPECT_EQ(state(), VerdictState::warming_up);
    EXPECT_EQ(machine_.verdict().isolated_mask, axis_1);
    EXPECT_EQ(machine_.verdict().excluded_from[1], 0U);
    for (std::uint64_t sequence = 1; sequence <= settings_.warm_up_frames; ++sequence) machine_.update({2, sequence}, healthy());
    EXPECT_EQ(state(), VerdictState::isolated);
}

TEST_F(VerdictMachineTest, isolates_right_after_the_warm_up_what_was_faulty_from_the_start)
{
    auto machine = VerdictMachine::make(settings_, 6).value();
    for (std::uint64_t sequence = 0; sequence < settings_.warm_up_frames; ++sequence) {
        machine.update({1, sequence}, naming(axis_1));
        EXPECT_EQ(machine.verdict().state, octet(VerdictState::warming_up));
    }
    machine.update({1, settings_.warm_up_frames}, naming(axis_1));
    EXPECT_EQ(machine.isolated(), axis_1);
    EXPECT_EQ(machine.verdict().excluded_from[1], 0U);
}

TEST_F(VerdictMachineTest, adopts_a_lane_s_exclusions_before_the_first_frame)
{
    auto machine = VerdictMachine::make(settings_, 6).value();
    auto excluded_from = Exclusions{};
    excluded_from[2] = 1681;
    machine.adopt(excluded_from);
    machine.update({1, 5000}, healthy());
    EXPECT_EQ(machine.isolated(), axis_2);
    EXPECT_EQ(machine.verdict().excluded_from[2], 1681U);
    EXPECT_EQ(machine.verdict().adopted, 1);
}

TEST_F(VerdictMachineTest, adopting_keeps_the_earlier_onset_of_an_axis_already_excluded)
{
    feed(naming(axis_1), 2);
    const auto onset = machine_.verdict().excluded_from[1];
    auto later = Exclusions{};
    later[1] = onset + 100;
    machine_.adopt(later);
    EXPECT_EQ(machine_.verdict().excluded_from[1], onset);
}

TEST_F(VerdictMachineTest, readmits_by_command_and_only_what_was_excluded)
{
    feed(naming(axis_1), 2);
    EXPECT_EQ(machine_.readmit(axis_1 | axis_2), axis_1);
    EXPECT_EQ(machine_.readmit(axis_1), 0U);
    feed(healthy());
    EXPECT_EQ(state(), VerdictState::healthy);
    EXPECT_EQ(machine_.verdict().excluded_from[1], never);
    EXPECT_EQ(feed(naming(axis_1), 2).isolated_mask, axis_1) << "a readmitted axis can be isolated again";
}

TEST_F(VerdictMachineTest, isolates_a_second_fault_beside_the_first)
{
    feed(naming(axis_1), 2);
    feed(healthy(), 100);
    const std::uint64_t second = next_;
    feed(naming(axis_2), 2);
    EXPECT_EQ(machine_.verdict().isolated_mask, axis_1 | axis_2);
    EXPECT_EQ(machine_.verdict().excluded_from[2], second - settings_.onset_guard_frames);
}

Assessment contradicting(AxisMask axes, std::uint64_t from)
{
    Assessment assessment{.outcome = Outcome::suspect, .isolated = axes};
    assessment.provisional = axes;
    assessment.provisional_from = from;
    return assessment;
}

TEST_F(VerdictMachineTest, leaves_a_contradicted_axis_out_at_once_and_takes_it_back_when_the_contradiction_ends)
{
    const std::uint64_t from = next_ - 4;
    feed(contradicting(axis_1, from));
    EXPECT_EQ(state(), VerdictState::provisional);
    EXPECT_EQ(machine_.verdict().isolated_mask, 0U);
    EXPECT_EQ(provisional_mask(machine_.verdict()), axis_1);
    EXPECT_EQ(machine_.verdict().excluded_from[1], from - settings_.onset_guard_frames);
    EXPECT_EQ(machine_.verdict().working_mask, 0b111101U);
    EXPECT_EQ(feed(contradicting(axis_1, from + 2), 100).excluded_from[1], from - settings_.onset_guard_frames) << "from where it began";

    feed(healthy());
    EXPECT_EQ(provisional_mask(machine_.verdict()), 0U);
    EXPECT_EQ(machine_.verdict().working_mask, 0b111111U);
    EXPECT_EQ(state(), VerdictState::healthy) << "an axis that returns is no longer suspect";
}

TEST_F(VerdictMachineTest, still_suspects_another_axis_when_one_returns)
{
    feed(contradicting(axis_1, next_), 20);
    Assessment both = contradicting(axis_1, next_);
    both.isolated |= axis_2;
    feed(both);
    feed(healthy());
    EXPECT_EQ(provisional_mask(machine_.verdict()), 0U);
    EXPECT_EQ(state(), VerdictState::suspect);
    EXPECT_NE(machine_.verdict().suspect_mask & axis_2, 0U);
}

TEST_F(VerdictMachineTest, latches_what_was_left_out_from_where_it_was_left_out)
{
    const std::uint64_t from = next_ - 4;
    feed(contradicting(axis_1, from), 30);
    Assessment named = naming(axis_1);
    named.onset = next_ - 8;
    named.provisional = axis_1;  // until it is excluded
    feed(named, 2);
    EXPECT_EQ(machine_.verdict().isolated_mask, axis_1);
    EXPECT_EQ(machine_.verdict().excluded_from[1], from - settings_.onset_guard_frames);
}

TEST_F(VerdictMachineTest, forgets_what_was_left_out_provisionally_in_a_new_epoch)
{
    feed(contradicting(axis_1, next_ - 1));
    machine_.update({2, 0}, healthy());
    EXPECT_EQ(machine_.verdict().excluded_from.mask(), 0U);
}

TEST_F(VerdictMachineTest, keeps_three_axes_whatever_is_contradicted)
{
    feed(contradicting(0b001111, next_ - 1), 5);
    EXPECT_EQ(provisional_mask(machine_.verdict()), 0U);
    EXPECT_EQ(state(), VerdictState::suspect);
}

TEST_F(VerdictMachineTest, says_saturated_while_all_are_and_blames_nobody)
{
    Assessment beyond = healthy();
    beyond.saturated = true;
    feed(beyond, 50);
    EXPECT_EQ(state(), VerdictState::saturated);
    EXPECT_EQ(machine_.verdict().isolated_mask | machine_.verdict().suspect_mask, 0U);
    feed(healthy());
    EXPECT_EQ(state(), VerdictState::healthy);
}

TEST_F(VerdictMachineTest, isolates_an_axis_that_its_own_values_prove_broken)
{
    feed(healthy(), 1, axis_2);
    EXPECT_EQ(state(), VerdictState::provisional) << "out at once";
    EXPECT_EQ(machine_.verdict().suspect_mask, axis_2);
    feed(healthy(), 1, axis_2);
    EXPECT_EQ(machine_.verdict().isolated_mask, axis_2);
    EXPECT_EQ(state(), VerdictState::isolated);
}

TEST_F(VerdictMachineTest, forgets_an_axis_that_was_broken_for_one_frame)
{
    feed(healthy(), 1, axis_2);
    feed(healthy(), 3);
    EXPECT_EQ(state(), VerdictState::healthy);
    EXPECT_EQ(machine_.verdict().suspect_mask, 0U);
}

TEST_F(VerdictMachineTest, is_blind_when_fewer_than_three_axes_are_left)
{
    feed(healthy(), 2, 0b111100);
    EXPECT_EQ(state(), VerdictState::blind);
    EXPECT_EQ(machine_.verdict().isolated_mask, 0b111100U);
}

TEST(VerdictMachine, refuses_settings_that_cannot_work)
{
    EXPECT_FALSE(VerdictMachine::make({.confirm_required = 0}, 6));
    EXPECT_FALSE(VerdictMachine::make({.confirm_required = 4, .confirm_window = 3}, 6));
    EXPECT_FALSE(VerdictMachine::make({.confirm_window = 33}, 6));
    EXPECT_FALSE(VerdictMachine::make({.readmit_after_s = 0.0}, 6));
    EXPECT_FALSE(VerdictMachine::make({}, 2));
    EXPECT_FALSE(VerdictMachine::make({}, 25));
    EXPECT_TRUE(VerdictMachine::make({.confirm_required = 32, .confirm_window = 32}, 24));
}

}  // namespace
}  // namespace quorient::fdi
