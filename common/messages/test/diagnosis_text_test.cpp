#include "quorient/messages/diagnosis_text.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <gtest/gtest.h>
#include <numbers>

namespace quorient {
namespace {

constexpr double degree = std::numbers::pi / 180;

FaultDiagnosis soft_axis()
{
    FaultDiagnosis diagnosis;
    diagnosis.kind = octet(SensorKind::gyro);
    diagnosis.diagnosis[2] = octet(Diagnosis::gain);
    diagnosis.size[2] = 0.47;
    diagnosis.sigma[2] = 0.011;
    diagnosis.bias[2] = -10.7 * degree;
    diagnosis.bias_sigma[2] = 0.12 * degree;
    return diagnosis;
}

TEST(DiagnosisText, says_what_is_wrong_and_by_how_much)
{
    EXPECT_EQ(diagnosis_text(soft_axis(), 2), "gain 0.470 +- 0.011, bias -10.70 +- 0.12 deg/s");
    EXPECT_EQ(diagnosis_text(soft_axis(), 1), "");
}

TEST(DiagnosisText, names_the_axes_as_the_description_does)
{
    ClusterDescription description;
    description.axis_count = 3;
    description.instrument_count = 1;
    copy_text("g0", description.instrument_name[0]);
    FaultDiagnosis diagnosis = soft_axis();
    diagnosis.diagnosis[1] = octet(Diagnosis::stuck);
    EXPECT_EQ(diagnoses_text(diagnosis, description, 0b111), "g0 y: stuck; g0 z: gain 0.470 +- 0.011, bias -10.70 +- 0.12 deg/s");
    EXPECT_EQ(diagnoses_text(diagnosis, description, 0b001), "");
}

TEST(DiagnosisText, does_not_trust_a_code)
{
    FaultDiagnosis diagnosis;
    diagnosis.diagnosis[0] = 255;
    EXPECT_EQ(diagnosis_text(diagnosis, 0), "");
    EXPECT_EQ(diagnosis_text(diagnosis, 500), "");
}

}  // namespace
}  // namespace quorient
