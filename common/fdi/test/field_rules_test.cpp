#include "field/field_detector.hpp"

#include "field_scene.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>

// Each rule of the field detector switched off: in which scene it is missed. The whole table: with all rules the scene ends well, without
// the rule it does not.

namespace quorient::fdi {
namespace {

constexpr std::uint64_t onset = 1200;
constexpr double frame_s = 0.01;
constexpr std::uint64_t seeds = 6;

/// What six arrays of different chance made of one scene.
struct Outcomes {
    unsigned named_sound = 0;  ///< arrays of which a sound instrument was isolated
    unsigned named_faulty = 0;
    unsigned left_out_frames = 0;
    double largest_lasting = 0;
    std::uint64_t left_out_delay = 0;  ///< the longest [frames]
    std::uint64_t named_delay = 0;     ///< likewise
};

struct Scene {
    std::function<FieldScene(std::uint64_t seed)> make;
    double seconds;
    AxisMask faulty = 0;
    DetectorSettings settings{};
};

std::uint64_t delay_of(std::uint64_t sequence)
{
    return sequence == never ? never : sequence - std::min(sequence, onset);
}

Outcomes play_all(const Scene& what, bool FieldRules::*without = nullptr)
{
    FieldRules rules;
    if (without != nullptr) rules.*without = false;
    Outcomes outcomes;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        FieldScene scene = what.make(seed);
        const auto detector = FieldDetector::make(what.settings, scene.cluster, rules).value();
        const Played result = play(scene, *detector, what.seconds);
        outcomes.named_sound += (result.named & ~what.faulty) != 0 ? 1U : 0U;
        outcomes.named_faulty += (result.named & what.faulty) != 0 ? 1U : 0U;
        outcomes.left_out_frames += result.provisional_frames;
        outcomes.largest_lasting = std::max(outcomes.largest_lasting, detector->largest_lasting());
        const std::uint64_t out = std::min(result.provisional_at, result.named_at);
        outcomes.left_out_delay = std::max(outcomes.left_out_delay, delay_of(out));
        outcomes.named_delay = std::max(outcomes.named_delay, delay_of(result.named_at));
    }
    return outcomes;
}

FieldScene spoiled(std::uint64_t seed, std::function<void(std::uint64_t, FieldScene::Rates&)> spoil, const Differences& differences = {})
{
    FieldScene scene(3, seed, differences);
    scene.spoil = std::move(spoil);
    return scene;
}

auto from_onset(std::function<void(FieldScene::Rates&)> spoil)
{
    return [spoil = std::move(spoil)](std::uint64_t sequence, FieldScene::Rates& rates) {
        if (sequence >= onset) spoil(rates);
    };
}

TEST(FieldRules, learning_makes_small_faults_of_moving_arrays_visible)
{
    const Scene scene{[](std::uint64_t seed) { return spoiled(seed, from_onset([](auto& rates) { rates[4] += 2; })); }, 20, axes_of(1)};
    EXPECT_EQ(play_all(scene).named_faulty, seeds);
    EXPECT_LT(play_all(scene, &FieldRules::learning).named_faulty, seeds);
}

TEST(FieldRules, persistence_keeps_shocks_from_being_latched)
{
    const Scene scene{[](std::uint64_t seed) {
                          return spoiled(seed, [](std::uint64_t sequence, FieldScene::Rates& rates) {
                              if (sequence >= onset && sequence < onset + 30) rates[4] += 150;
                          });
                      },
                      16};
    EXPECT_EQ(play_all(scene).named_sound, 0U);
    EXPECT_GT(play_all(scene, &FieldRules::persistence).named_sound, 0U);
}

TEST(FieldRules, agreement_of_the_others_keeps_a_shock_that_all_feel_differently_from_naming_one)
{
    const Scene scene{[](std::uint64_t seed) {
                          return spoiled(seed, [](std::uint64_t sequence, FieldScene::Rates& rates) {
                              if (sequence < onset || sequence >= onset + 60) return;
                              const double fading = std::exp(-3 * frame_s * static_cast<double>(sequence - onset));
                              rates[1] += 60 * fading;
                              rates[4] -= 50 * fading;
                              rates[7] += 20 * fading;
                          });
                      },
                      20};
    EXPECT_EQ(play_all(scene).named_sound, 0U);
    EXPECT_GT(play_all(scene, &FieldRules::others_must_agree).named_sound, 0U);
}

TEST(FieldRules, noise_of_the_others_judges_a_faulty_instrument_that_would_hide_in_its_own)
{
    const Scene scene{[](std::uint64_t seed) { return spoiled(seed, from_onset([](auto& rates) { rates[4] -= 60; })); }, 16, axes_of(1)};
    EXPECT_LE(play_all(scene).named_delay, 50U);
    EXPECT_GT(play_all(scene, &FieldRules::leave_one_out).named_delay, 50U);
}

/// Instrument 1 repeats each second measurement: a fault that looks like noise of its neighbours.
TEST(FieldRules, of_three_the_noise_of_the_sound_pair_judges_one_at_half_rate)
{
    const Scene scene{[](std::uint64_t seed) {
                          return spoiled(seed, [last = std::array<double, 3>{}](std::uint64_t sequence, FieldScene::Rates& rates) mutable {
                              const auto first = rates.begin() + 3;
                              if (sequence >= onset && sequence % 2 == 1) std::ranges::copy(last, first);
                              std::copy_n(first, last.size(), last.begin());
                          });
                      },
                      32, axes_of(1)};
    const Outcomes outcomes = play_all(scene);
    EXPECT_EQ(outcomes.named_faulty, seeds);
    EXPECT_EQ(outcomes.named_sound, 0U);
}

TEST(FieldRules, clipping_lets_one_sample_of_full_scale_pass_soon)
{
    const Scene scene{[](std::uint64_t seed) {
                          return spoiled(seed, [](std::uint64_t sequence, FieldScene::Rates& rates) {
                              if (sequence == onset) rates[4] -= 1900;
                          });
                      },
                      20};
    EXPECT_LE(play_all(scene).left_out_frames, 100 * seeds);
    EXPECT_GT(play_all(scene, &FieldRules::clipping).left_out_frames, 300 * seeds);
}

TEST(FieldRules, dead_zone_keeps_a_long_rest_from_teaching_gains)
{
    const Scene scene{[](std::uint64_t seed) {
                          FieldScene resting(3, seed, Differences{.noise_deg_s = 0.3});
                          resting.motion = FieldScene::flight_after(300);
                          return resting;
                      },
                      330};
    EXPECT_LT(play_all(scene).largest_lasting, 0.45);
    EXPECT_GT(play_all(scene, &FieldRules::dead_zone).largest_lasting, 0.5);
}

TEST(FieldRules, smallest_angle_leaves_nothing_out_that_cannot_matter_to_the_attitude)
{
    // Single samples of 9 deg/s too much: 0.09 degrees each.
    const Scene scene{[](std::uint64_t seed) {
                          return spoiled(seed, [](std::uint64_t sequence, FieldScene::Rates& rates) {
                              if (sequence > 600 && sequence % 500 == 0) rates[4] += 9;
                          });
                      },
                      30};
    EXPECT_EQ(play_all(scene).left_out_frames, 0U);
    EXPECT_GT(play_all(scene, &FieldRules::smallest_angle).left_out_frames, 0U);
}

TEST(FieldRules, erratic_finds_noise_that_no_window_shows)
{
    const Scene scene{[](std::uint64_t seed) {
                          return spoiled(seed, from_onset([random = std::mt19937_64(seed), noise = std::normal_distribution<double>(0, 4)](
                                                              auto& rates) mutable { rates[7] += noise(random); }));
                      },
                      18, axes_of(2)};
    EXPECT_EQ(play_all(scene).named_faulty, seeds);
    EXPECT_LT(play_all(scene, &FieldRules::erratic).named_faulty, seeds);
}

TEST(FieldRules, outside_class_names_a_resting_bias_that_no_sound_instrument_has)
{
    const Scene scene{[](std::uint64_t seed) {
                          FieldScene biased(3, seed);
                          biased.set_bias(1, 2, -11);
                          return biased;
                      },
                      4, axes_of(1)};
    EXPECT_EQ(play_all(scene).named_faulty, seeds);
    EXPECT_LT(play_all(scene, &FieldRules::outside_class).named_faulty, seeds);
}

TEST(FieldRules, fast_lane_leaves_a_small_fault_of_a_calibrated_array_out_sooner)
{
    const Scene scene{[](std::uint64_t seed) {
                          FieldScene calibrated = spoiled(seed, from_onset([](auto& rates) { rates[4] += 1; }),
                                                          Differences{.bias_deg_s = 0, .gain = 0, .delay_s = 0, .drift_deg_s = 0});
                          calibrated.cluster.sigma.setConstant(0.11 * degree * frame_s);
                          return calibrated;
                      },
                      20,
                      axes_of(1),
                      {.motion_noise = 1.0, .calibrated = true}};
    const Outcomes with = play_all(scene);
    const Outcomes without = play_all(scene, &FieldRules::fast_lane);
    EXPECT_EQ(with.named_sound, 0U);
    EXPECT_LT(with.left_out_delay, without.left_out_delay);
}

/// Twelve seconds of rest, which teach no gain; then turns to and fro of up to 25 deg/s in vibration that each instrument feels in its own way.
Scene take_off(double gain, Mount mount = Mount::board)
{
    return {[gain](std::uint64_t seed) {
                FieldScene scene = spoiled(seed, from_onset([gain](auto& rates) { rates[4] *= gain; }), {.own_vibration_deg_s = 0.4});
                scene.motion = [](double t) -> Eigen::Vector3d {
                    const double flown = std::max(0.0, t - 12);
                    return std::min(1.0, 10 * flown) * Eigen::Vector3d(10 * std::sin(5 * t), 25 * std::sin(6 * flown), 10 * std::sin(3 * t));
                };
                return scene;
            },
            18, gain == 1 ? 0 : axes_of(1), {.mount = mount}};
}

TEST(FieldRules, brief_gains_leave_a_gain_out_before_it_lasts)
{
    constexpr std::uint64_t soon = 25;
    const Outcomes with = play_all(take_off(0.8));
    EXPECT_EQ(with.named_sound, 0U);
    EXPECT_EQ(with.named_faulty, seeds);
    EXPECT_LE(with.left_out_delay, soon);
    EXPECT_GT(play_all(take_off(0.8), &FieldRules::brief_gains).left_out_delay, soon);
}

TEST(FieldRules, brief_gains_leave_no_sound_instrument_out)
{
    EXPECT_EQ(play_all(take_off(1)).left_out_frames, 0U);
}

TEST(FieldRules, brief_gains_are_not_looked_for_on_a_structure)
{
    const Scene scene = take_off(0.8, Mount::structure);
    EXPECT_EQ(play_all(scene).left_out_delay, play_all(scene, &FieldRules::brief_gains).left_out_delay);
}

TEST(FieldRules, saturation_blames_nobody_where_all_are_at_their_range)
{
    const Scene scene{[](std::uint64_t seed) {
                          FieldScene spinning(3, seed);
                          spinning.motion = [](double t) -> Eigen::Vector3d {
                              return FieldScene::flight(t) +
                                     Eigen::Vector3d(0, 0, t > 8 && t < 15 ? 3000 * std::sin(std::numbers::pi * (t - 8) / 7) : 0);
                          };
                          return spinning;
                      },
                      23};
    const Outcomes with = play_all(scene);
    const Outcomes without = play_all(scene, &FieldRules::saturation);
    EXPECT_EQ(with.named_sound, 0U);
    EXPECT_TRUE(without.named_sound > 0 || without.left_out_frames > with.left_out_frames);
}

}  // namespace
}  // namespace quorient::fdi
