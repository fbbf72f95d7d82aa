// A restarted integrator takes over what the voters stand for, and mends it when that turns out to have had a fault in it.

#include "../../test/rig.hpp"
#include "integrator_service.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <map>
#include <random>

namespace quorient::integrator {

namespace {

using test::Rig;

constexpr std::uint32_t faulty = 0b0010;
constexpr double error_rad = 5e-4;     // by a bias of 0.05 rad/s in two frames
constexpr double rounding_rad = 2e-6;  // and the sensors' resolution
constexpr double bridged_rad = 1e-5;   // and the coning in a few lost frames

using Quaternion = std::array<double, 4>;

/// p o q
Quaternion product(const Quaternion& p, const Quaternion& q)
{
    return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3], p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1], p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

double angle_between(Quaternion from, const Quaternion& to)
{
    for (std::size_t i = 1; i < 4; ++i) from[i] = -from[i];
    const auto turn = product(from, to);
    return 2 * std::hypot(turn[1], turn[2], turn[3]);
}

/// By another lane than the one under test, which two stand behind.
VotedAttitude vouched(const Rig& rig, std::uint64_t sequence, const Quaternion& attitude)
{
    VotedAttitude voted;
    voted.unit = rig.system.unit;
    voted.voter = 1;
    voted.epoch = Rig::first_epoch;
    voted.sequence = sequence;
    voted.output_sequence = sequence + 1;
    voted.attitude = attitude;
    voted.reset_rotation = {1, 0, 0, 0};
    voted.primary_lane = rig.system.lanes.front().integrator.integration.lane + 1;
    voted.level = octet(VoteLevel::degraded);
    voted.excluded_from.fill(never);
    return voted;
}

class Seed : public testing::Test {
protected:
    /// Starts in the middle of a stream.
    Seed()
    {
        rig.frames(static_cast<unsigned>(onset));
        integrator.emplace(rig, rig.system.lanes.front().integrator);
        frames(2);
        EXPECT_EQ(rig.attitude().mode, octet(AttitudeMode::initialising));
    }

    void frames(unsigned count)
    {
        for (unsigned i = 0; i < count; ++i) {
            rig.frame(*integrator);
            truth[rig.truth().sequence] = rig.truth().attitude;
        }
    }

    /// About the newest frame, with this error about x.
    VotedAttitude voted(double off_rad, std::uint32_t isolated = 0) const
    {
        const Quaternion off{std::cos(off_rad / 2), std::sin(off_rad / 2), 0, 0};
        auto voted = vouched(rig, rig.truth().sequence, product(rig.truth().attitude, off));
        voted.isolated_mask = isolated;
        if (isolated != 0) voted.excluded_from[1] = onset;
        return voted;
    }

    void say(const VotedAttitude& voted)
    {
        rig.publish(bus::topics::voter_output, voted);
        rig.run(*integrator);
    }

    /// This lane's detector: the axis is faulty, from before what was taken over.
    void isolate()
    {
        FaultVerdict verdict;
        verdict.unit = rig.system.unit;
        verdict.detector = rig.system.lanes.front().integrator.detector;
        verdict.epoch = rig.truth().epoch;
        verdict.sequence = rig.truth().sequence;
        verdict.state = octet(VerdictState::isolated);
        verdict.isolated_mask = faulty;
        verdict.excluded_from.fill(never);
        verdict.excluded_from[1] = onset;
        rig.publish(bus::topics::verdict, verdict);
        rig.run(*integrator);
    }

    /// The angle of the last attitude to the truth of its frame: one that waits for a verdict is not the newest.
    double away_rad() const { return angle_between(truth.at(rig.attitude().sequence), rig.attitude().attitude); }

    static constexpr std::uint64_t onset = 20;
    Rig rig;
    std::optional<Rig::Process<IntegratorService>> integrator;
    std::map<std::uint64_t, Quaternion> truth;
};

TEST_F(Seed, with_a_fault_in_it_is_mended_by_the_lanes_that_have_corrected_themselves)
{
    say(voted(error_rad));
    frames(2);
    EXPECT_NEAR(away_rad(), error_rad, rounding_rad);
    isolate();
    frames(3);
    EXPECT_NEAR(away_rad(), error_rad, rounding_rad) << "its own roll-back does not reach there";
    say(voted(0, faulty));
    frames(3);
    EXPECT_LT(away_rad(), rounding_rad);
    EXPECT_EQ(rig.attitude().seeded, 1);

    say(voted(error_rad, faulty));
    frames(3);
    EXPECT_LT(away_rad(), rounding_rad) << "once";
}

TEST_F(Seed, is_mended_too_where_the_first_verdict_came_before_it)
{
    isolate();
    say(voted(error_rad));
    frames(2);
    isolate();
    say(voted(0, faulty));
    frames(3);
    EXPECT_LT(away_rad(), rounding_rad);
}

TEST_F(Seed, stays_where_nothing_speaks_against_it)
{
    say(voted(0));
    frames(2);
    say(voted(error_rad));
    say(voted(error_rad, faulty));
    frames(3);
    EXPECT_LT(away_rad(), rounding_rad);
}

TEST_F(Seed, is_mended_by_nobody_who_has_the_fault_himself_or_stands_alone_or_repeats_this_lane)
{
    say(voted(0));
    frames(2);
    isolate();
    frames(2);

    say(voted(error_rad));
    auto alone = voted(error_rad, faulty);
    alone.level = octet(VoteLevel::single);
    say(alone);
    auto own = voted(error_rad, faulty);
    own.primary_lane = rig.system.lanes.front().integrator.integration.lane;
    say(own);
    frames(3);
    EXPECT_LT(away_rad(), rounding_rad);
}

/// The second voter's word on the same frame, when frames behind it have been lost already.
TEST_F(Seed, is_not_taken_from_before_a_gap_in_which_nobody_knows_what_turned)
{
    integrator.reset();
    const auto before = voted(0);
    rig.lose(1);
    integrator.emplace(rig, rig.system.lanes.front().integrator);
    say(before);
    rig.lose(30);
    frames(2);
    say(before);
    frames(2);
    EXPECT_EQ(rig.attitude().mode, octet(AttitudeMode::initialising));
    say(voted(0));
    frames(3);
    EXPECT_EQ(rig.attitude().mode, octet(AttitudeMode::normal));
    EXPECT_LT(away_rad(), rounding_rad);
}

TEST_F(Seed, that_knew_of_the_fault_is_sound)
{
    say(voted(0, faulty));
    frames(2);
    isolate();
    frames(2);
    say(voted(error_rad, faulty));
    frames(3);
    EXPECT_LT(away_rad(), rounding_rad);
}

/// Frames are lost; of the voted attitudes some come late, some before their frame, some not at all.
class Chance {
public:
    explicit Chance(unsigned seed, const std::map<std::uint64_t, Quaternion>& truth)
        : random_(seed), truth_(truth), integrator_(rig_, rig_.system.lanes.front().integrator)
    {
        rig_.frames(first_heard - 1);
        next_voted_ = first_heard - 1 - draw(20);
        losses_in_ten_ = 2 * draw(3);
    }

    /// @returns the last attitude.
    AttitudeState play()
    {
        while (rig_.next_sequence() < truth_.size()) {
            while (next_voted_ <= std::min(rig_.next_sequence(), truth_.size() - 1) && draw(3) != 0) say();
            if (draw(4) == 0) say_again();
            if (draw(10) < losses_in_ten_) rig_.lose(1);
            else rig_.frame(integrator_);
        }
        return rig_.attitude();
    }

private:
    static constexpr unsigned first_heard = 40;

    unsigned draw(unsigned below) { return std::uniform_int_distribution<unsigned>{0, below - 1}(random_); }

    void say()
    {
        newest_voted_ = vouched(rig_, next_voted_, truth_.at(next_voted_));
        say_again();
        next_voted_ += 1 + draw(2);
    }

    /// As the second voter does, a little or much later.
    void say_again()
    {
        if (newest_voted_.epoch == 0) return;
        rig_.publish(bus::topics::voter_output, newest_voted_);
        rig_.run(integrator_);
    }

    std::mt19937 random_;
    const std::map<std::uint64_t, Quaternion>& truth_;
    Rig rig_;
    Rig::Process<IntegratorService> integrator_;
    VotedAttitude newest_voted_;
    std::uint64_t next_voted_ = 0;
    unsigned losses_in_ten_ = 0;
};

TEST(SeedByChance, leads_to_the_true_attitude_or_to_none)
{
    constexpr unsigned trials = 600;
    std::map<std::uint64_t, Quaternion> truth;
    for (Rig oracle; oracle.next_sequence() < 120;) {
        oracle.frame();
        truth[oracle.truth().sequence] = oracle.truth().attitude;
    }
    unsigned known = 0;
    for (unsigned seed = 1; seed <= trials; ++seed) {
        const auto attitude = Chance(seed, truth).play();
        if (mode_of(attitude) == AttitudeMode::initialising) continue;
        ++known;
        EXPECT_LT(angle_between(truth.at(attitude.sequence), attitude.attitude), bridged_rad) << "seed " << seed;
    }
    EXPECT_GT(known, trials / 2);
}

}  // namespace

}  // namespace quorient::integrator
