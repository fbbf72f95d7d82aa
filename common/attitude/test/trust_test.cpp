#include "checked_integrator.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <numbers>

namespace quorient::attitude {
namespace {

using namespace testing;

constexpr double interval_s = 0.005;
const ClassicConing motion(20, 2);

// A detector's life over 120 frames, with everything that may happen to trust in it.
std::vector<FaultVerdict> eventful_verdicts(std::mt19937_64& random, std::size_t axes)
{
    std::vector<FaultVerdict> verdicts;
    Exclusions from;
    AxisMask isolated = all_axes(axes);
    for (std::uint64_t sequence = 0; sequence < 120; ++sequence) {
        const std::size_t axis = random() % axes;
        if (random() % 12 == 0) from[axis] = sequence - std::min<std::uint64_t>(sequence, random() % 40);  // isolated, or revised
        if (random() % 25 == 0) from[random() % axes] = never;                                             // re-admitted
        constexpr std::array states{VerdictState::healthy,   VerdictState::suspect,    VerdictState::isolated,    VerdictState::blind,
                                    VerdictState::ambiguous, VerdictState::warming_up, VerdictState::provisional, VerdictState::saturated};
        FaultVerdict verdict = verdict_on(sequence, states[random() % 3 == 0 ? random() % states.size() : 2]);
        verdict.excluded_from = from;
        if (state_of(verdict) == VerdictState::warming_up) verdict.excluded_from = Exclusions{};
        verdict.isolated_mask = verdict.excluded_from.mask() & isolated;  // the others are left out provisionally
        if (random() % 10 == 0) isolated ^= axis_bit(random() % axes);
        verdict.suspect_mask = axis_bit(axis);
        verdict.candidate_count = 2;
        verdict.candidate_set[0] = axis_bit(axis);
        verdict.candidate_set[1] = axis_bit((axis + 1) % axes);
        verdict.residual[axis] = 1e-6 * static_cast<double>(random() % 100);
        if (random() % 8 != 0) verdicts.push_back(verdict);  // some are lost
    }
    return verdicts;
}

TEST(Trust, converges_to_the_same_attitude_in_whatever_order_verdicts_come)
{
    const auto cluster = cluster_of("dodecahedron", interval_s, 1e-6);
    Instrument instrument(cluster, motion);
    instrument.set_noise(1e-5, 5);  // so that every set of axes gives another attitude
    const auto frames = record(instrument, 120);

    int interleavings = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        std::mt19937_64 random(seed);
        const auto verdicts = eventful_verdicts(random, cluster.size());
        CheckedIntegrator in_order = integrator_for(cluster, motion);
        std::size_t next = 0;
        for (const auto& frame : frames) {
            for (; next < verdicts.size() && verdicts[next].sequence <= frame.sequence; ++next) in_order.apply(verdicts[next]);
            in_order.add(frame);
        }
        finish(in_order);

        for (int trial = 0; trial < 10; ++trial, ++interleavings) {
            auto shuffled = verdicts;
            for (std::size_t i = 0; i < 20; ++i) shuffled.push_back(verdicts[random() % verdicts.size()]);
            std::shuffle(shuffled.begin(), shuffled.end(), random);
            if (trial % 2 == 0)  // neighbours only: most arrive before or just after their frame
                std::ranges::sort(shuffled, {}, [&](const FaultVerdict& v) { return v.sequence / 8; });
            CheckedIntegrator mixed = integrator_for(cluster, motion);
            std::size_t received = 0;
            for (const auto& frame : frames) {
                for (std::size_t n = random() % 3; n > 0 && received < shuffled.size() && shuffled[received].sequence <= frame.sequence + 30; --n)
                    mixed.apply(shuffled[received++]);
                mixed.add(frame);
                if (random() % 2 == 0) mixed.work();
            }
            for (; received < shuffled.size(); ++received) mixed.apply(shuffled[received]);
            finish(mixed);
            ASSERT_EQ(mixed.state().attitude, in_order.state().attitude) << "seed " << seed << ", trial " << trial;
            ASSERT_EQ(mixed.state().angle_sigma_rad, in_order.state().angle_sigma_rad) << "seed " << seed << ", trial " << trial;
            ASSERT_EQ(mixed.state().excluded_from, in_order.state().excluded_from) << "seed " << seed << ", trial " << trial;
            ASSERT_EQ(mixed.state().isolated_mask, in_order.state().isolated_mask) << "seed " << seed << ", trial " << trial;
        }
    }
    std::printf("%d interleavings converged\n", interleavings);
}

TEST(Trust, is_latched_through_warm_up_ambiguity_blindness_and_silence)
{
    const auto cluster = cluster_of("dodecahedron", interval_s, 1e-6);
    const auto frames = record(Instrument(cluster, motion), 30);
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    for (const auto& frame : frames) {
        if (frame.sequence == 5) integrator.apply(isolating(5, 3, 4));
        if (frame.sequence == 10) integrator.apply(verdict_on(10, VerdictState::warming_up));
        if (frame.sequence == 14) integrator.apply(verdict_on(14, VerdictState::ambiguous));
        if (frame.sequence == 18) integrator.apply(verdict_on(18, VerdictState::blind));
        if (frame.sequence == 22) integrator.apply(verdict_on(22, VerdictState::unknown));
        integrator.add(frame);
        const AxisMask expected = frame.sequence >= 5 ? axis_bit(3) : 0;
        EXPECT_EQ(integrator.state().isolated_mask, expected) << frame.sequence;
    }
    integrator.apply(verdict_on(29));
    EXPECT_EQ(integrator.state().isolated_mask, 0u) << "a healthy verdict that does not exclude it re-admits";
}

TEST(Trust, of_another_epoch_is_ignored_if_old_and_kept_if_new)
{
    const auto cluster = cluster_of("dodecahedron", interval_s, 1e-6);
    auto frames = record(Instrument(cluster, motion), 10);
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    FaultVerdict early = isolating(0, 1, 0);  // before its epoch's first frame
    integrator.apply(early);
    integrator.add(frames[0]);
    EXPECT_EQ(integrator.state().isolated_mask, axis_bit(1));
    FaultVerdict old = isolating(1, 4, 0);
    old.epoch = 0;
    integrator.apply(old);
    EXPECT_EQ(integrator.state().isolated_mask, axis_bit(1));
}

// Runs a hard-over from `onset` on; the verdict on each frame is there before the frame, confirmation comes two frames later.
// @returns the largest error of the attitudes published from the onset on [rad].
double largest_error_with_hard_over(const std::string& layout, std::size_t axis, bool leave_out)
{
    constexpr std::uint64_t onset = 60;
    const auto cluster = cluster_of(layout, interval_s, 1e-6);
    Instrument instrument(cluster, motion);
    instrument.set_fault(axis, onset, [](double, auto) { return 2000 * std::numbers::pi / 180 * interval_s; });
    IntegratorSettings settings;
    settings.history_s = 1;
    settings.initial_attitude = to_array(motion.attitude(0));
    settings.leave_out_suspects = leave_out;
    CheckedIntegrator integrator = CheckedIntegrator::make(settings, cluster);
    double largest = 0;
    for (std::uint64_t sequence = 0; sequence < onset + 10; ++sequence) {
        integrator.apply(sequence < onset       ? verdict_on(sequence)
                         : sequence < onset + 2 ? suspecting(sequence, axis_bit(axis))
                                                : isolating(sequence, axis, onset));
        integrator.add(instrument.next());
        const auto state = integrator.publish();
        if (sequence >= onset) largest = std::max(largest, angle_to(state, instrument.attitude_after(sequence)));
        EXPECT_TRUE(!leave_out || state.reset_counter == 0) << layout << ": leaving a suspect out needs no reset";
    }
    return largest;
}

TEST(Suspect, a_hard_over_never_reaches_the_attitude_on_any_layout_where_it_can_be_left_out)
{
    for (const auto& layout : all_layouts()) {
        const auto cluster = cluster_of(layout, interval_s, 1e-6);
        const BodyIncrement body(cluster);
        for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
            if (!body.well_conditioned(cluster.all() & ~axis_bit(axis))) {
                EXPECT_EQ(cluster.size(), 3u) << layout << " could not do without axis " << axis;
                continue;
            }
            EXPECT_LT(largest_error_with_hard_over(layout, axis, true), 1e-9) << layout << ", axis " << axis;
            const double turn_rad = 2000 * std::numbers::pi / 180 * interval_s;
            EXPECT_GT(largest_error_with_hard_over(layout, axis, false),
                      turn_rad * body.solve(cluster.all()).gain.col(static_cast<Eigen::Index>(axis)).norm())
                << layout << ", axis " << axis;
        }
    }
}

TEST(Suspect, that_turns_out_healthy_leaves_nothing_to_undo)
{
    const auto cluster = cluster_of("dodecahedron", interval_s, 1e-6);
    const auto frames = record(Instrument(cluster, motion), 20);
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    for (const auto& frame : frames) {
        integrator.apply(frame.sequence == 8 ? suspecting(8, axis_bit(2)) : verdict_on(frame.sequence));
        integrator.add(frame);
        const auto state = integrator.publish();
        EXPECT_EQ(state.used_mask, frame.sequence == 8 ? cluster.all() & ~axis_bit(2) : cluster.all());
        EXPECT_EQ(state.reset_counter, 0u);
        EXPECT_EQ(mode_of(state), AttitudeMode::normal);
    }
}

TEST(Suspect, without_a_name_changes_no_axis_and_enlarges_the_standard_deviation)
{
    const auto cluster = cluster_of("dodecahedron", interval_s, 1e-6);
    const auto frames = record(Instrument(cluster, motion), 20);
    CheckedIntegrator doubting = integrator_for(cluster, motion);
    CheckedIntegrator calm = integrator_for(cluster, motion);
    for (const auto& frame : frames) {
        FaultVerdict verdict = suspecting(frame.sequence, 0);
        verdict.residual[1] = 1e-4;
        doubting.apply(verdict);
        calm.apply(verdict_on(frame.sequence));
        doubting.add(frame);
        calm.add(frame);
    }
    EXPECT_EQ(doubting.state().used_mask, cluster.all());
    EXPECT_EQ(doubting.state().attitude, calm.state().attitude);
    EXPECT_NEAR(doubting.state().angle_sigma_rad, 20e-4, 1e-5);
    EXPECT_LT(calm.state().angle_sigma_rad, 1e-5);
}

FaultVerdict ambiguous(std::uint64_t sequence, AxisMask first, AxisMask second)
{
    FaultVerdict verdict = verdict_on(sequence, VerdictState::ambiguous);
    verdict.candidate_count = 2;
    verdict.candidate_set[0] = first;
    verdict.candidate_set[1] = second;
    return verdict;
}

TEST(Ambiguity, leaves_out_all_candidates_if_the_rest_can_do_it_and_says_so_if_not)
{
    const auto six = cluster_of("dodecahedron", interval_s, 1e-6);
    CheckedIntegrator enough = integrator_for(six, motion);
    enough.apply(ambiguous(0, axis_bit(0), axis_bit(5)));
    enough.add(Instrument(six, motion).next());
    EXPECT_EQ(enough.state().used_mask, six.all() & ~(axis_bit(0) | axis_bit(5)));
    EXPECT_EQ(mode_of(enough.state()), AttitudeMode::normal);

    const auto four = cluster_of("cone-4", interval_s, 1e-6);
    CheckedIntegrator few = integrator_for(four, motion);
    few.apply(ambiguous(0, axis_bit(0), axis_bit(1)));
    few.add(Instrument(four, motion).next());
    EXPECT_EQ(few.state().used_mask, four.all());
    EXPECT_EQ(mode_of(few.state()), AttitudeMode::ambiguous);
}

TEST(Ambiguity, is_resolved_in_the_past_when_the_culprit_is_named)
{
    const auto cluster = cluster_of("cone-4", interval_s, 1e-6);
    Instrument instrument(cluster, motion);
    instrument.set_fault(1, 50, [](double z, auto) { return z + 0.01; });
    const auto frames = record(instrument, 80);
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    for (const auto& frame : frames) {
        if (frame.sequence < 50) integrator.apply(verdict_on(frame.sequence));
        else if (frame.sequence < 70) integrator.apply(ambiguous(frame.sequence, axis_bit(0), axis_bit(1)));
        else integrator.apply(isolating(frame.sequence, 1, 50));
        integrator.add(frame);
        const double error = angle_to(integrator.state(), instrument.attitude_after(frame.sequence));
        EXPECT_TRUE(frame.sequence != 69 || error > 0.01) << error;
    }
    EXPECT_LT(angle_to(integrator.state(), instrument.attitude_after(79)), 1e-9);
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::normal);
}

TEST(Blindness, keeps_the_last_trusted_axes_and_is_not_to_be_trusted)
{
    const auto cluster = cluster_of("dodecahedron", interval_s, 1e-6);
    const auto frames = record(Instrument(cluster, motion), 3);
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    integrator.apply(isolating(0, 2, 0));
    integrator.add(frames[0]);
    integrator.apply(verdict_on(1, VerdictState::blind));
    integrator.add(frames[1]);
    EXPECT_EQ(integrator.state().used_mask, cluster.all() & ~axis_bit(2));
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::untrusted);
    integrator.add(frames[2]);  // no verdict: the last word stands
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::untrusted);
}

}  // namespace
}  // namespace quorient::attitude
