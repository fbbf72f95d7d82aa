#include "checked_integrator.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace quorient::attitude {
namespace {

using namespace testing;

constexpr double interval_s = 0.01;
constexpr std::size_t history_frames = 60;
constexpr std::uint64_t onset = 70;
const ClassicConing motion(20, 2);

struct Fault {
    const char* name;
    Distortion distortion;
};

std::vector<Fault> fault_kinds()
{
    return {{"bias", [](double z, auto) { return z + 1e-3; }},
            {"ramp", [](double z, auto k) { return z + 1e-5 * static_cast<double>(k); }},
            {"scale", [](double z, auto) { return 0.8 * z; }},
            {"stuck", [held = 0.0](double z, auto k) mutable { return held = k == 0 ? z : held; }},
            {"zero", [](double, auto) { return 0.0; }},
            {"rail", [](double, auto) { return 2000 * interval_s * 3.14159 / 180; }},
            {"sign", [](double z, auto) { return -z; }},
            {"oscillation", [](double z, auto k) { return z + 1e-2 * std::sin(static_cast<double>(k)); }},
            {"spike", [](double z, auto k) { return z + (k % 7 == 0 ? 0.3 : 0); }}};
}

// What a detector says that needs `delay` frames: it suspects another axis at first, then the right one, then it is sure.
FaultVerdict late_verdict(std::uint64_t sequence, std::size_t axis, std::size_t axes, std::uint64_t delay)
{
    if (sequence >= onset + delay) return isolating(sequence, axis, onset);
    if (sequence + 1 == onset + delay) return suspecting(sequence, axis_bit(axis));
    if (sequence == onset) return suspecting(sequence, axis_bit((axis + 1) % axes));
    return verdict_on(sequence);
}

void expect_same_bits(const AttitudeState& a, const AttitudeState& b, const std::string& what)
{
    EXPECT_EQ(a.attitude, b.attitude) << what;
    EXPECT_EQ(a.angle_sigma_rad, b.angle_sigma_rad) << what;
    EXPECT_EQ(a.used_mask, b.used_mask) << what;
    EXPECT_EQ(a.mode, b.mode) << what;
}

// @returns how many comparisons of whole runs were made.
int compare_with_undelayed(const std::string& layout, const Fault& fault, std::uint64_t delay)
{
    const auto cluster = cluster_of(layout, interval_s, 1e-6);
    const std::size_t axis = onset % cluster.size();
    Instrument instrument(cluster, motion);
    instrument.set_fault(axis, onset, fault.distortion);
    const auto frames = record(instrument, onset + delay + 15);

    CheckedIntegrator late = integrator_for(cluster, motion, history_frames * interval_s);
    CheckedIntegrator at_once = integrator_for(cluster, motion, history_frames * interval_s);
    CheckedIntegrator never_used = integrator_for(cluster, motion, history_frames * interval_s);
    never_used.apply(isolating(0, axis, 0));
    const std::string what = layout + ", " + fault.name + ", " + std::to_string(delay) + " frames late";
    for (const auto& frame : frames) {
        late.apply(late_verdict(frame.sequence, axis, cluster.size(), delay));
        at_once.apply(frame.sequence >= onset ? isolating(frame.sequence, axis, onset) : verdict_on(frame.sequence));
        late.add(frame);
        at_once.add(frame);
        never_used.add(frame);
        finish(late);
        if (frame.sequence < onset + delay) continue;
        expect_same_bits(late.publish(), at_once.publish(), what);
        if (mode_of(late.state()) == AttitudeMode::coasting) continue;
        EXPECT_LE(angle_to(late.state(), from_array(never_used.state().attitude)), 1e-12) << what;
    }
    EXPECT_EQ(late.history_too_short(), 0u) << what;
    return 1;
}

TEST(Rollback, equals_bit_for_bit_a_run_that_knew_at_once_on_every_layout_for_every_fault_and_delay)
{
    int runs = 0;
    for (const auto& layout : all_layouts())
        for (const auto& fault : fault_kinds())
            for (const std::uint64_t delay : {1, 2, 3, 9, 10, 11, 30, 59, 60}) {
                runs += compare_with_undelayed(layout, fault, delay);
                if (HasFailure()) return;
            }
    RecordProperty("runs", runs);
    std::printf("%d runs compared\n", runs);
}

// One axis of cone-6 broken from `onset` on; verdicts as given by `verdict_at`. @returns the state after the last frame.
template <class VerdictAt>
AttitudeState run(const std::vector<SensorFrame>& frames, const geometry::SensorCluster& cluster, const VerdictAt& verdict_at,
                  bool rollback = true)
{
    CheckedIntegrator integrator = integrator_for(cluster, motion, history_frames * interval_s, rollback);
    for (const auto& frame : frames) {
        integrator.apply(verdict_at(frame.sequence));
        integrator.add(frame);
        finish(integrator);
        integrator.publish();
    }
    return integrator.state();
}

class OneFault : public ::testing::Test {
protected:
    static constexpr std::size_t axis = 2;

    OneFault()
    {
        Instrument instrument(cluster, motion);
        instrument.set_fault(axis, onset, [](double z, auto) { return z + 0.01; });
        frames = record(instrument, 100);
        truth = instrument.attitude_after(99);
    }

    geometry::SensorCluster cluster = cluster_of("cone-6", interval_s, 1e-6);
    std::vector<SensorFrame> frames;
    Quaternion truth;
};

TEST_F(OneFault, leaves_no_error_behind_with_rollback_and_a_lasting_one_without)
{
    const auto verdict_at = [](std::uint64_t sequence) {
        return sequence >= onset + 20 ? isolating(sequence, axis, onset) : verdict_on(sequence);
    };
    const auto with = run(frames, cluster, verdict_at, true);
    const auto without = run(frames, cluster, verdict_at, false);
    EXPECT_LT(angle_to(with, truth), 1e-9);
    EXPECT_GT(angle_to(without, truth), 0.01);
    EXPECT_EQ(with.used_mask, without.used_mask);
    EXPECT_EQ(with.reset_counter, 1u);
    EXPECT_EQ(without.reset_counter, 0u);
}

TEST_F(OneFault, is_announced_by_a_reset_that_turns_the_old_attitude_into_the_new)
{
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    for (std::uint64_t sequence = 0; sequence < 90; ++sequence) {
        integrator.apply(verdict_on(sequence));
        integrator.add(frames[sequence]);
    }
    const auto old = integrator.publish();
    integrator.apply(isolating(89, axis, onset));
    const auto corrected = integrator.state();

    EXPECT_EQ(corrected.sequence, old.sequence);
    EXPECT_EQ(corrected.reset_counter, old.reset_counter + 1);
    EXPECT_EQ(corrected.rolled_back_frames, 20u);
    const Quaternion turned = from_array(corrected.reset_rotation) * from_array(old.attitude);
    EXPECT_LT((turned.coeffs() - from_array(corrected.attitude).coeffs()).norm(), 4e-16);
    EXPECT_GT(angle_between(from_array(old.attitude), from_array(corrected.attitude)), 1e-3);

    // It rides on the next attitude too, and is not announced twice.
    integrator.apply(isolating(90, axis, onset));
    integrator.add(frames[90]);
    EXPECT_EQ(integrator.state().reset_counter, corrected.reset_counter);
    EXPECT_EQ(integrator.state().reset_rotation, corrected.reset_rotation);
    EXPECT_EQ(integrator.state().rolled_back_frames, 0u);
}

TEST_F(OneFault, that_is_named_before_the_frame_is_published_needs_no_reset)
{
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        integrator.add(frames[sequence]);
        integrator.apply(sequence >= onset ? isolating(sequence, axis, onset) : verdict_on(sequence));
        integrator.publish();
    }
    EXPECT_EQ(integrator.state().reset_counter, 0u);
    EXPECT_LT(angle_to(integrator.state(), truth), 1e-9);
}

TEST_F(OneFault, reaching_past_the_history_is_counted_and_corrected_as_far_as_it_goes)
{
    CheckedIntegrator shorter = integrator_for(cluster, motion, 10 * interval_s);
    CheckedIntegrator uncorrected = integrator_for(cluster, motion, 10 * interval_s, false);
    for (const auto& frame : frames) {
        for (CheckedIntegrator* integrator : {&shorter, &uncorrected}) {
            integrator->apply(frame.sequence >= 95 ? isolating(frame.sequence, axis, onset) : verdict_on(frame.sequence));
            integrator->add(frame);
        }
    }
    EXPECT_EQ(shorter.history_too_short(), 1u);
    EXPECT_EQ(shorter.state().reset_counter, 1u);
    // 21 records of history, nine of them only for the window: frames 70 to 82 stay contaminated, of 70 to 94 without rollback.
    EXPECT_NEAR(angle_to(shorter.state(), truth) / angle_to(uncorrected.state(), truth), 13.0 / 25, 0.02);
}

TEST_F(OneFault, whose_onset_is_revised_is_taken_from_where_the_newest_verdict_says)
{
    for (const std::uint64_t first_opinion : {60, 65, 75}) {
        const auto revised = run(frames, cluster, [&](std::uint64_t sequence) {
            return sequence >= 90   ? isolating(sequence, axis, onset)
                   : sequence >= 80 ? isolating(sequence, axis, first_opinion)
                                    : verdict_on(sequence);
        });
        const auto at_once = run(frames, cluster, [](std::uint64_t sequence) {
            return sequence >= onset ? isolating(sequence, axis, onset) : verdict_on(sequence);
        });
        expect_same_bits(revised, at_once, "first opinion " + std::to_string(first_opinion));
    }
}

TEST_F(OneFault, readmitted_changes_no_attitude_by_itself)
{
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    for (std::uint64_t sequence = 0; sequence < 90; ++sequence) {
        integrator.apply(sequence >= 80 ? isolating(sequence, axis, onset) : verdict_on(sequence));
        integrator.add(frames[sequence]);
    }
    const auto before = integrator.publish();
    integrator.apply(verdict_on(90));
    EXPECT_EQ(integrator.state().attitude, before.attitude);
    EXPECT_EQ(integrator.state().reset_counter, before.reset_counter);

    integrator.add(frames[90]);
    EXPECT_EQ(integrator.state().used_mask, cluster.all());
    EXPECT_EQ(integrator.state().reset_counter, before.reset_counter);

    // A later correction of another axis does not bring the forgiven past back.
    FaultVerdict other = isolating(91, 0, 60);
    integrator.apply(other);
    integrator.add(frames[91]);
    finish(integrator);
    auto expected = integrator_for(cluster, motion);
    for (std::uint64_t sequence = 0; sequence <= 91; ++sequence) {
        FaultVerdict verdict = sequence >= 60 ? isolating(sequence, 0, 60) : verdict_on(sequence);
        if (sequence >= onset && sequence < 90) verdict.excluded_from[axis] = onset;
        expected.apply(verdict);
        expected.add(frames[sequence]);
    }
    EXPECT_EQ(integrator.state().attitude, expected.state().attitude);
}

TEST_F(OneFault, is_corrected_in_slices_while_new_frames_keep_coming)
{
    constexpr std::size_t many = 2000;
    Instrument instrument(cluster, motion);
    instrument.set_fault(axis, 100, [](double z, auto) { return z + 1e-4; });
    const auto long_run = record(instrument, many + 100);
    CheckedIntegrator integrator = integrator_for(cluster, motion, many * interval_s);
    for (std::size_t i = 0; i < many; ++i) integrator.add(long_run[i]);
    const auto old = integrator.publish();

    integrator.apply(isolating(many - 1, axis, 100));
    EXPECT_EQ(integrator.state().attitude, old.attitude) << "a pending correction must not show in part";
    std::size_t frame = many;
    for (; integrator.state().reset_counter == 0; ++frame) {
        ASSERT_LT(frame, long_run.size());
        integrator.add(long_run[frame]);
        const auto state = integrator.publish();
        const double error = angle_to(state, instrument.attitude_after(frame));
        EXPECT_TRUE(error < 1e-9 || error > 0.05) << "neither the old track nor the new one: " << error;
    }
    EXPECT_NEAR(static_cast<double>(frame - many), static_cast<double>(many - 100) / 128, 2);

    CheckedIntegrator at_once = integrator_for(cluster, motion, many * interval_s);
    at_once.apply(isolating(0, axis, 100));
    for (std::size_t i = 0; i < frame; ++i) at_once.add(long_run[i]);
    EXPECT_EQ(integrator.state().attitude, at_once.state().attitude);
}

}  // namespace
}  // namespace quorient::attitude
