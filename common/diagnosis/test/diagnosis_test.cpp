#include "a_diagnosis.hpp"

#include "quorient/diagnosis/words.hpp"

#include <gmock/gmock.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <deque>
#include <random>

namespace quorient::diagnosis {
namespace {

using fdi::degree;
using fdi::FieldScene;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

INSTANTIATE_TEST_SUITE_P(Seeds, ADiagnosis, testing::Values(1U, 2U, 3U), [](const auto& its) { return "seed_" + std::to_string(its.param); });

TEST_P(ADiagnosis, of_sound_gyros_finds_nothing)
{
    const Report report = diagnose(scene, length_s);

    EXPECT_FALSE(report.found_anything()) << report.sentence;
    EXPECT_THAT(report.sentence, HasSubstr("No gyro is faulty"));
    EXPECT_THAT(report.rests, SizeIs(1));
    EXPECT_FALSE(report.attitude);
}

TEST_P(ADiagnosis, states_the_biases_that_the_gyros_have_at_rest)
{
    scene.set_bias(1, 2, 1.5);
    const Report report = diagnose(scene, length_s);

    ASSERT_TRUE(report.instruments[1].bias_deg_s);
    EXPECT_TRUE(report.instruments[1].bias_from_rest);
    EXPECT_NEAR((*report.instruments[1].bias_deg_s)(2), 1.5, 0.05);
    ASSERT_TRUE(report.instruments[1].gain);
    EXPECT_NEAR((*report.instruments[1].gain)(2), 1, 0.04);
    ASSERT_TRUE(report.instruments[1].noise_rest_deg_s);
    EXPECT_NEAR((*report.instruments[1].noise_rest_deg_s)(2), 0.1, 0.02);
}

TEST_P(ADiagnosis, names_a_bias_with_its_size_and_its_beginning)
{
    spoil_axis(scene, 4, [](double rate) { return rate + 10; });
    const Report report = diagnose(scene, length_s);
    const Finding finding = only_of(1, report);

    EXPECT_EQ(finding.kind, Kind::bias);
    EXPECT_EQ(finding.axis, 1U);
    EXPECT_NEAR(finding.size, 10, 0.5);
    EXPECT_NEAR(finding.from_s, onset_s, 0.1);
    EXPECT_FALSE(finding.to_s);
    ASSERT_TRUE(report.attitude);
    EXPECT_GT(report.attitude->alone_deg, 30);
}

TEST_P(ADiagnosis, says_when_a_bias_ended)
{
    constexpr double end_s = 16;
    spoil_axis(scene, 4, [](double rate) { return rate + 10; }, onset_s, end_s);
    const Report report = diagnose(scene, length_s);
    const Finding finding = only_of(1, report);

    EXPECT_EQ(finding.kind, Kind::bias);
    EXPECT_NEAR(finding.size, 10, 1);
    ASSERT_TRUE(finding.to_s);
    EXPECT_NEAR(*finding.to_s, end_s, 1.1);
}

TEST_P(ADiagnosis, names_a_gain_that_was_there_from_the_first_sample)
{
    spoil_axis(scene, 2, [](double rate) { return 0.46 * rate - 10.7; }, 0);
    const Report report = diagnose(scene, length_s);
    const Finding finding = only_of(0, report);

    EXPECT_EQ(finding.kind, Kind::gain);
    EXPECT_EQ(finding.axis, 2U);
    EXPECT_NEAR(finding.size, 0.46, 0.02);
    ASSERT_TRUE(finding.bias_deg_s);
    EXPECT_NEAR(*finding.bias_deg_s, -10.7, 1.2);
    EXPECT_LT(finding.from_s, 3);
}

TEST_P(ADiagnosis, names_a_reversed_axis)
{
    spoil_axis(scene, 6, [](double rate) { return -rate; });
    const Finding finding = only_of(2, diagnose(scene, length_s));

    EXPECT_EQ(finding.kind, Kind::sign);
    EXPECT_EQ(finding.axis, 0U);
}

TEST_P(ADiagnosis, names_a_stuck_axis_and_one_that_is_stuck_at_zero)
{
    spoil_axis(scene, 3, [](double) { return 3.7; });
    const Finding stuck = only_of(1, diagnose(scene, length_s));
    EXPECT_EQ(stuck.kind, Kind::stuck);
    EXPECT_EQ(stuck.axis, 0U);

    FieldScene other(3, GetParam() + 100);
    spoil_axis(other, 3, [](double) { return 0.0; });
    const Finding zero = only_of(1, diagnose(other, length_s));
    EXPECT_EQ(zero.kind, Kind::zero);
    EXPECT_EQ(zero.axis, 0U);
}

TEST_P(ADiagnosis, names_an_instrument_that_is_late)
{
    std::array<std::deque<double>, 3> waiting;
    scene.spoil = [waiting](std::uint64_t, FieldScene::Rates& rates) mutable {
        for (std::size_t i = 0; i < 3; ++i) {
            waiting[i].push_back(rates[3 + i]);
            rates[3 + i] = waiting[i].front();
            if (waiting[i].size() > 3) waiting[i].pop_front();
        }
    };
    const Finding finding = only_of(1, diagnose(scene, length_s));

    EXPECT_EQ(finding.kind, Kind::delay);
    EXPECT_NEAR(finding.size, 0.03, 0.006);
}

TEST_P(ADiagnosis, names_noise)
{
    std::mt19937_64 random(GetParam());
    std::normal_distribution<double> normal(0, 25);
    spoil_axis(scene, 8, [=](double rate) mutable { return rate + normal(random); });
    const Finding finding = only_of(2, diagnose(scene, length_s));

    EXPECT_EQ(finding.kind, Kind::noise);
    EXPECT_EQ(finding.axis, 2U);
}

TEST_P(ADiagnosis, names_a_mounting_that_is_turned_by_right_angles)
{
    const Eigen::Matrix3d about_z = Eigen::AngleAxisd(90 * degree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    scene.mount(1, about_z.transpose());  // rows: where its axes point
    const Report report = diagnose(scene, length_s);
    const Finding finding = only_of(1, report);

    EXPECT_EQ(finding.kind, Kind::mounting);
    EXPECT_NEAR(finding.size, 90, 1e-6);
    EXPECT_THAT(finding.remark, HasSubstr("90 degrees about z"));
    EXPECT_THAT(with(report, Certainty::isolated), SizeIs(1)) << "the rest of it is sound";
    ASSERT_TRUE(report.instruments[1].rotation);
    EXPECT_LT(report.instruments[1].rotation->angularDistance(Eigen::Quaterniond(about_z)), 3 * degree);
}

TEST_P(ADiagnosis, finds_a_fault_in_an_instrument_that_is_turned_besides)
{
    scene.mount(1, Eigen::AngleAxisd(180 * degree, Eigen::Vector3d::UnitX()).toRotationMatrix());
    spoil_axis(scene, 3, [](double rate) { return rate + 20; });
    const Report report = diagnose(scene, length_s);
    const auto isolated = with(report, Certainty::isolated);

    ASSERT_THAT(isolated, SizeIs(2));
    for (const Finding& finding : isolated) {
        EXPECT_EQ(finding.instrument, 1U);
        if (finding.kind == Kind::mounting) continue;
        EXPECT_EQ(finding.kind, Kind::bias);
        EXPECT_EQ(finding.axis, 0U);
        EXPECT_NEAR(finding.size, 20, 1);
    }
}

TEST_P(ADiagnosis, takes_any_turn_between_separate_logs_for_their_mounting)
{
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(70 * degree, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    scene.mount(1, turn);
    auto survey = survey_of(scene, length_s);
    survey.logs.resize(3, survey.logs.front());
    for (std::size_t m = 0; m < 3; ++m) survey.instruments[m].log = m;
    SceneFrames frames(scene, length_s);
    const Report report = diagnose(survey, frames, {});

    EXPECT_FALSE(report.found_anything()) << report.sentence;
    ASSERT_TRUE(report.instruments[1].rotation);
    EXPECT_LT(report.instruments[1].rotation->angularDistance(Eigen::Quaterniond(turn.transpose())), 3 * degree);
}

TEST_P(ADiagnosis, names_a_wrong_unit)
{
    scene.spoil = [](std::uint64_t, FieldScene::Rates& rates) {
        for (std::size_t i = 0; i < 3; ++i) rates[i] *= 57.29578;
    };
    const Report report = diagnose(scene, length_s);
    const Finding finding = only_of(0, report);

    EXPECT_EQ(finding.kind, Kind::unit);
    EXPECT_NEAR(finding.size, 57.3, 0.1);
    EXPECT_THAT(with(report, Certainty::isolated), SizeIs(1));
}

TEST_P(ADiagnosis, names_an_instrument_that_is_silent_while_the_others_go_on)
{
    const double interval_s = scene.cluster.interval_s;
    scene.spoil = [=](std::uint64_t sequence, FieldScene::Rates& rates) {
        const double time_s = static_cast<double>(sequence) * interval_s;
        if (time_s > 12 && time_s < 15) rates[3] = rates[4] = rates[5] = std::numeric_limits<double>::quiet_NaN();
    };
    const Finding finding = only_of(1, diagnose(scene, length_s));

    EXPECT_EQ(finding.kind, Kind::missing);
    EXPECT_NEAR(finding.from_s, 12, 0.05);
    ASSERT_TRUE(finding.to_s);
    EXPECT_NEAR(*finding.to_s, 15, 0.05);
}

TEST_P(ADiagnosis, calls_a_short_shock_a_transient)
{
    spoil_axis(scene, 4, [](double rate) { return rate + 100; }, 12, 12.08);
    const Report report = diagnose(scene, length_s);

    EXPECT_FALSE(report.found_anything()) << report.sentence;
    const auto transients = with(report, Certainty::transient);
    ASSERT_FALSE(transients.empty());
    EXPECT_EQ(transients.front().instrument, 1U);
    EXPECT_NEAR(transients.front().from_s, 12, 0.1);
}

TEST_P(ADiagnosis, of_two_names_neither)
{
    FieldScene two(2, GetParam());
    spoil_axis(two, 1, [](double rate) { return rate + 20; });
    const Report report = diagnose(two, length_s);

    EXPECT_THAT(with(report, Certainty::isolated), IsEmpty());
    const auto detected = with(report, Certainty::detected);
    ASSERT_FALSE(detected.empty());
    EXPECT_FALSE(detected.front().instrument);
    EXPECT_THAT(detected.front().candidates, ElementsAre(0U, 1U));
    EXPECT_NEAR(detected.front().from_s, onset_s, 0.4);
    EXPECT_THAT(report.sentence, HasSubstr("nobody can say which"));

    FieldScene sound(2, GetParam());
    EXPECT_FALSE(diagnose(sound, length_s).found_anything());
}

TEST_P(ADiagnosis, of_two_names_the_one_whose_own_values_prove_it)
{
    FieldScene two(2, GetParam());
    spoil_axis(two, 4, [](double) { return 3.7; });
    const Report report = diagnose(two, length_s);
    const Finding finding = only_of(1, report);

    EXPECT_EQ(finding.kind, Kind::stuck);
    EXPECT_EQ(finding.axis, 1U);
    EXPECT_NEAR(finding.from_s, onset_s, 0.05);
    EXPECT_THAT(with(report, Certainty::detected), IsEmpty()) << "the disagreement is explained";
}

TEST_P(ADiagnosis, names_spikes_that_come_again_and_again)
{
    scene.spoil = [](std::uint64_t sequence, FieldScene::Rates& rates) {
        if (sequence % 200 == 150) rates[3] = -2000;
    };
    const Finding finding = only_of(1, diagnose(scene, length_s));

    EXPECT_EQ(finding.kind, Kind::spikes);
    EXPECT_EQ(finding.axis, 0U);
    EXPECT_NEAR(finding.size, 2000, 200);

    FieldScene rare(3, GetParam() + 100);
    rare.spoil = [](std::uint64_t sequence, FieldScene::Rates& rates) {
        if (sequence % 1500 == 1000) rates[3] += 60;
    };
    EXPECT_FALSE(diagnose(rare, length_s).found_anything()) << "sound instruments have shocks";
}

TEST_P(ADiagnosis, takes_an_axis_that_ends_at_its_range_for_no_faulty_one)
{
    static constexpr double range_deg_s = 25;
    spoil_axis(scene, 3, [](double rate) { return std::clamp(rate, -range_deg_s, range_deg_s); }, 0);
    SceneFrames frames(scene, length_s);
    recording::Survey survey = survey_of(scene, length_s);
    EXPECT_THAT(with(diagnose(survey, frames, {}), Certainty::isolated), SizeIs(testing::Ge(1U))) << "nothing in the values shows the range";

    survey.instruments[1].figures.range_reached[0] = recording::Clipping{range_deg_s * degree, 700, 5'000'000'000, 25'000'000'000};
    const Report report = diagnose(survey, frames, {});

    EXPECT_THAT(with(report, Certainty::isolated), IsEmpty()) << report.sentence;
    EXPECT_THAT(report.sentence, HasSubstr("IMU1 x is at its range (700 samples at 25 deg/s) from 5.00 s to 25.00 s"));
}

TEST_P(ADiagnosis, tells_a_structure_that_flexes_from_a_board)
{
    const auto says = [](const Report& report) { return report.remarks.empty() ? std::string() : report.remarks.back(); };
    EXPECT_THAT(says(diagnose(scene, length_s)), testing::Not(HasSubstr("flexes")));

    FieldScene structure(3, GetParam());
    const double interval_s = structure.cluster.interval_s;
    structure.spoil = [=](std::uint64_t sequence, FieldScene::Rates& rates) {
        const double vibration = 12 * std::sin(2 * std::numbers::pi * 17 * static_cast<double>(sequence) * interval_s);
        for (std::size_t axis = 0; axis < rates.size(); ++axis) rates[axis] += vibration * (axis < 3 ? 1.0 : axis < 6 ? 0.6 : 0.3);
    };
    Options options;
    options.mount = fdi::Mount::structure;
    EXPECT_THAT(says(diagnose(structure, length_s, options)), HasSubstr("flexes"));
}

TEST_P(ADiagnosis, of_two_that_are_turned_against_each_other_names_neither)
{
    FieldScene two(2, GetParam());
    two.mount(1, Eigen::AngleAxisd(90 * degree, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    const Report report = diagnose(two, length_s);

    ASSERT_THAT(with(report, Certainty::detected), SizeIs(1));
    EXPECT_EQ(report.findings.front().kind, Kind::mounting);
    EXPECT_THAT(report.findings.front().candidates, ElementsAre(0U, 1U));
}

TEST_P(ADiagnosis, of_one_gyro_says_that_there_is_nothing_to_compare)
{
    auto survey = survey_of(scene, length_s);
    survey.compared.resize(1);
    SceneFrames frames(scene, length_s);
    const Report report = diagnose(survey, frames, {});

    EXPECT_FALSE(report.found_anything());
    EXPECT_THAT(report.sentence, HasSubstr("nothing to compare"));
}

TEST_P(ADiagnosis, of_a_few_samples_says_that_they_are_too_few)
{
    const Report report = diagnose(scene, 0.4);

    EXPECT_FALSE(report.found_anything());
    EXPECT_THAT(report.sentence, HasSubstr("too little to judge"));
}

}  // namespace
}  // namespace quorient::diagnosis
