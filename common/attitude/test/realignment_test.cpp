// What sets the attitude anew: a reset, a new epoch.
#include "an_integrator.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <cmath>

namespace quorient::attitude {
namespace {

using namespace testing;

TEST_F(AnIntegrator, of_a_new_epoch_keeps_its_exclusions_and_is_lost_until_aligned)
{
    integrator.apply(isolating(0, 3, 0));
    for (int i = 0; i < 20; ++i) integrator.add(instrument.next());
    const auto before = integrator.publish();
    Instrument restarted(cluster, motion);
    SensorFrame frame = restarted.next();
    frame.epoch = 2;
    integrator.add(frame);
    const auto after = integrator.publish();
    EXPECT_EQ(after.epoch, 2u);
    EXPECT_EQ(after.sequence, 0u);
    EXPECT_EQ(mode_of(after), AttitudeMode::lost);
    EXPECT_EQ(after.isolated_mask, axis_bit(3));
    EXPECT_EQ(after.excluded_from[3], 0u);
    EXPECT_LT(angle_to(after, from_array(before.attitude)), 0.02) << "the attitude goes on from where it was";

    FaultVerdict late = isolating(15, 1, 2);  // a verdict of the old epoch
    integrator.apply(late);
    EXPECT_EQ(integrator.state().isolated_mask, axis_bit(3));
}

TEST_F(AnIntegrator, starts_a_new_epoch_from_the_attitude_that_its_description_states)
{
    for (int i = 0; i < 20; ++i) integrator.add(instrument.next());
    integrator.begin_epoch(2, to_array(motion.attitude(0)));
    Instrument restarted(cluster, motion);
    for (int i = 0; i < 30; ++i) {
        SensorFrame frame = restarted.next();
        frame.epoch = 2;
        integrator.add(frame);
    }
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::normal);
    EXPECT_LT(angle_to(integrator.state(), restarted.attitude_after(29)), 1e-13);
    EXPECT_EQ(integrator.state().reset_counter, 1u);
}

TEST_F(AnIntegrator, is_reset_by_command_and_announces_it)
{
    for (int i = 0; i < 30; ++i) integrator.add(instrument.next());
    const auto before = integrator.publish();
    const Quaternion ordered = from_rotation_vector({0.5, 0, 0});
    ASSERT_TRUE(integrator.reset(to_array(ordered), 29));
    const auto after = integrator.state();
    EXPECT_EQ(after.sequence, before.sequence);
    EXPECT_EQ(after.reset_counter, before.reset_counter + 1);
    EXPECT_LT(angle_to(after, ordered), 1e-15);
    EXPECT_LT(angle_between(from_array(after.reset_rotation) * from_array(before.attitude), ordered), 1e-15);

    integrator.apply(isolating(29, 1, 10));  // what was before the reset needs no correction any more
    EXPECT_EQ(integrator.state().attitude, after.attitude);
    EXPECT_EQ(integrator.history_too_short(), 0u);
}

TEST_F(AnIntegrator, agrees_with_another_that_was_reset_to_the_same_attitude_at_another_frame)
{
    CheckedIntegrator later = CheckedIntegrator::make({}, cluster);
    Instrument same(cluster, motion);
    const Quaternion ordered = from_rotation_vector({0.1, -0.4, 0.3});
    for (int i = 0; i < 400; ++i) {
        if (i == 31) {
            ASSERT_TRUE(integrator.reset(to_array(ordered), 30));
        }
        if (i == 390) {
            ASSERT_TRUE(later.reset(to_array(ordered), 30));
        }
        integrator.add(instrument.next());
        integrator.publish();
        later.add(same.next());
        if (i != 390) later.publish();
        while (integrator.work() || later.work()) {
        }
    }
    const Quaternion turned = instrument.attitude_after(30).conjugate() * instrument.attitude_after(399);
    EXPECT_EQ(integrator.state().attitude, later.state().attitude);
    EXPECT_LT(angle_to(integrator.state(), ordered * turned), 3e-6);
    EXPECT_EQ(later.state().reset_counter, 1u);
}

TEST_F(AnIntegrator, refuses_a_reset_at_a_frame_that_it_does_not_have)
{
    EXPECT_FALSE(integrator.reset({1, 0, 0, 0}, 0)) << "no frame yet";
    for (int i = 0; i < 30; ++i) integrator.add(instrument.next());
    const auto before = integrator.publish();
    EXPECT_FALSE(integrator.reset({0, 1, 0, 0}, 30)) << "still to come";
    for (int i = 30; i < 3000; ++i) integrator.add(instrument.next());
    EXPECT_FALSE(integrator.reset({0, 1, 0, 0}, 3)) << "older than the history";
    EXPECT_EQ(integrator.state().reset_counter, before.reset_counter);
}

}  // namespace
}  // namespace quorient::attitude
