// Kind and size of a fault, against the one that was put in.

#include "field/field_detector.hpp"

#include "field_scene.hpp"

#include <gtest/gtest.h>

namespace quorient::fdi {
namespace {

constexpr std::uint64_t onset = 1200;
constexpr double onset_s = 12;
constexpr double significant = 3;  // standard deviations

std::unique_ptr<FieldDetector> detector_on(const FieldScene& scene)
{
    return FieldDetector::make({}, scene.cluster).value();
}

/// One axis says something else from the onset on; the diagnoses ten seconds later.
Played diagnosed(std::size_t axis, std::uint64_t seed, const std::function<double(double)>& fault, double seconds = 10)
{
    FieldScene scene(3, seed);
    scene.spoil = [&](std::uint64_t sequence, FieldScene::Rates& rates) {
        if (sequence >= onset) rates[axis] = fault(rates[axis]);
    };
    const auto detector = detector_on(scene);
    return play(scene, *detector, onset_s + seconds);
}

/// The axis has this diagnosis, and no other axis has any.
void expect_alone(const Played& result, std::size_t axis, Diagnosis kind)
{
    for (std::size_t other = 0; other < 9; ++other)
        EXPECT_EQ(result.diagnosis[other].kind, other == axis ? kind : Diagnosis::none) << "axis " << other;
}

TEST(FieldDiagnosis, tells_a_bias_and_its_size)
{
    for (std::size_t axis = 0; axis < 9; ++axis)
        for (const double size : {2.0, -5.0, 22.9, -60.0}) {
            SCOPED_TRACE("axis " + std::to_string(axis) + ", " + std::to_string(size) + " deg/s");
            const Played result = diagnosed(axis, 30 + axis, [&](double rate) { return rate + size; });
            expect_alone(result, axis, Diagnosis::bias);
            const AxisDiagnosis& found = result.diagnosis[axis];
            EXPECT_NEAR(found.size / degree, size, significant * found.sigma / degree);
            EXPECT_EQ(found.bias, found.size);
            EXPECT_LT(found.sigma / degree, 0.4);
        }
}

TEST(FieldDiagnosis, tells_a_gain_and_the_bias_beside_it)
{
    for (std::size_t axis = 0; axis < 9; ++axis)
        for (const double gain : {0.47, 0.8, 1.3}) {
            SCOPED_TRACE("axis " + std::to_string(axis) + ", gain " + std::to_string(gain));
            const Played result = diagnosed(axis, 50 + axis, [&](double rate) { return gain * rate - 10.7; });
            expect_alone(result, axis, Diagnosis::gain);
            const AxisDiagnosis& found = result.diagnosis[axis];
            // The axis had a gain of its own, known to the class's 1.5 %, before the fault; its bias was taken out at rest.
            EXPECT_NEAR(found.size, gain, significant * std::hypot(found.sigma, 0.015 * gain));
            EXPECT_NEAR(found.bias / degree, -10.7, significant * std::hypot(found.bias_sigma / degree, 0.7));
            EXPECT_LT(found.sigma, 0.03);
        }
}

TEST(FieldDiagnosis, tells_a_wrong_sign)
{
    for (std::size_t axis = 0; axis < 9; ++axis) {
        SCOPED_TRACE("axis " + std::to_string(axis));
        const Played result = diagnosed(axis, 70 + axis, [](double rate) { return -rate; });
        expect_alone(result, axis, Diagnosis::sign);
        EXPECT_NEAR(result.diagnosis[axis].size, -1, 0.05);
    }
}

TEST(FieldDiagnosis, tells_stuck_from_zero)
{
    double held = 0;
    bool holds = false;
    const auto stuck = [&](double rate) {
        if (!holds) held = rate;
        holds = true;
        return held;
    };
    expect_alone(diagnosed(4, 80, stuck), 4, Diagnosis::stuck);
    expect_alone(diagnosed(4, 80, [](double) { return 0.0; }), 4, Diagnosis::zero);
}

TEST(FieldDiagnosis, tells_a_delay_on_all_axes_of_the_instrument)
{
    FieldScene scene(3, 81);
    FieldScene::Rates last(9);
    scene.spoil = [&](std::uint64_t sequence, FieldScene::Rates& rates) {
        const FieldScene::Rates now = rates;
        for (std::size_t axis = 6; sequence >= onset && axis < 9; ++axis) rates[axis] = last[axis];
        last = now;
    };
    const Played result = play(scene, *detector_on(scene), onset_s + 10);
    for (std::size_t axis = 0; axis < 9; ++axis) {
        SCOPED_TRACE("axis " + std::to_string(axis));
        const AxisDiagnosis& found = result.diagnosis[axis];
        ASSERT_EQ(found.kind, axis < 6 ? Diagnosis::none : Diagnosis::delay);
        if (axis < 6) continue;
        EXPECT_NEAR(found.size, 0.01, significant * std::hypot(found.sigma, 0.4e-3));
    }
}

TEST(FieldDiagnosis, tells_noise_by_its_multiple)
{
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, 4);
    const Played result = diagnosed(7, 82, [&](double rate) { return rate + noise(random); });
    expect_alone(result, 7, Diagnosis::noise);
    EXPECT_GT(result.diagnosis[7].size, 10);
    EXPECT_LT(result.diagnosis[7].size, 60) << "4 deg/s beside noise of 0.1 and what the motion adds to it";
}

TEST(FieldDiagnosis, tells_a_wrong_mounting_by_its_angle)
{
    FieldScene scene(3, 83);
    scene.spoil = [&](std::uint64_t sequence, FieldScene::Rates& rates) {  // turned by 90 degrees about its z
        if (sequence >= onset) rates[3] = std::exchange(rates[4], -rates[3]);
    };
    const Played result = play(scene, *detector_on(scene), onset_s + 10);
    for (std::size_t axis = 0; axis < 9; ++axis) {
        SCOPED_TRACE("axis " + std::to_string(axis));
        const bool turned = axis == 3 || axis == 4;
        ASSERT_EQ(result.diagnosis[axis].kind, turned ? Diagnosis::mounting : Diagnosis::none);
        if (!turned) continue;
        EXPECT_NEAR(result.diagnosis[axis].size / degree, 90, 3);
    }
}

TEST(FieldDiagnosis, tells_a_resting_bias_outside_the_class_by_its_size)
{
    FieldScene scene(3, 84);
    scene.set_bias(1, 2, -11);
    const Played result = play(scene, *detector_on(scene), 10);
    EXPECT_TRUE(result.diagnosis[5].kind == Diagnosis::outside_class || result.diagnosis[5].kind == Diagnosis::bias);
    EXPECT_NEAR(result.diagnosis[5].size / degree, -11, 2) << "beside the others, whose biases differ by 0.7 deg/s";
}

TEST(FieldDiagnosis, says_nothing_of_sound_instruments)
{
    FieldScene scene(3, 85);
    const Played result = play(scene, *detector_on(scene), 30);
    for (std::size_t axis = 0; axis < 9; ++axis) EXPECT_EQ(result.diagnosis[axis].kind, Diagnosis::none);
}

}  // namespace
}  // namespace quorient::fdi
