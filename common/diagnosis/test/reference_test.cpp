#include "a_diagnosis.hpp"

#include "quorient/diagnosis/words.hpp"

#include <gmock/gmock.h>

namespace quorient::diagnosis {
namespace {

using fdi::FieldScene;
using testing::HasSubstr;

TEST_P(ADiagnosis, with_a_healthy_log_finds_a_small_bias_that_was_there_from_the_first_sample)
{
    fdi::Differences differences;
    differences.drift_deg_s = 0;
    constexpr std::uint64_t same = 11;
    const auto in_motion = [](double t) { return FieldScene::flight(t); };
    FieldScene healthy(3, same, differences);
    SceneFrames healthy_frames(healthy, length_s);
    const auto reference = reference_of(survey_of(healthy, length_s), healthy_frames, {});
    ASSERT_TRUE(reference) << reference.error();
    Options options;
    options.reference = *reference;

    FieldScene sound(3, same, differences);
    sound.motion = in_motion;
    EXPECT_FALSE(diagnose(sound, length_s, options).found_anything());

    FieldScene faulty(3, same, differences);
    faulty.motion = in_motion;
    spoil_axis(faulty, 4, [](double rate) { return rate + 4; }, 0);
    const Report report = diagnose(faulty, length_s, options);
    const Finding finding = only_of(1, report);
    EXPECT_EQ(finding.axis, 1U);
    EXPECT_NEAR(finding.size, 4, 0.5) << words_of(finding) << " " << report.sentence;
}

TEST_P(ADiagnosis, refuses_a_faulty_log_as_a_reference)
{
    spoil_axis(scene, 4, [](double rate) { return rate + 20; });
    SceneFrames frames(scene, length_s);
    const auto reference = reference_of(survey_of(scene, length_s), frames, {});

    ASSERT_FALSE(reference);
    EXPECT_THAT(reference.error(), HasSubstr("not a healthy log"));
}

}  // namespace
}  // namespace quorient::diagnosis
