#include "quorient/system/system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>

using namespace quorient;
using testing::AllOf;
using testing::HasSubstr;

namespace {

const std::string configuration = QUORIENT_SOURCE_DIR "/deploy/configurations/vessel.yaml";

tl::expected<system::System, std::string> loaded(const std::vector<std::string>& set)
{
    return system::load(configuration, {.dds = {}, .domain = {}, .processes = {"fdi-a"}, .set = set});
}

/// What the file is refused for when a value is another; "accepted" if it is not.
std::string refusal(const std::vector<std::string>& set)
{
    const auto system = loaded(set);
    return system ? "accepted" : system.error();
}

}  // namespace

TEST(VesselFile, describes_detectors_and_neither_integrators_nor_voters)
{
    const auto system = loaded({});
    ASSERT_TRUE(system) << system.error();
    EXPECT_FALSE(system->has_attitude());
    EXPECT_TRUE(system->voters.empty());
    EXPECT_EQ(system->sensor.consumers, (std::vector<std::string>{"fdi-a", "fdi-b"}));
    EXPECT_EQ(system->channels, (std::vector<std::string>{"sway_velocity", "yaw_rate"}));
    ASSERT_TRUE(system->detector("fdi-b")->observers);
    EXPECT_EQ(system->detector("fdi-b")->observers->scheme, fdi::ObserverScheme::directional);
    EXPECT_EQ(system->detector("fdi-a")->observers->sigma, std::vector<double>{2e-4}) << "the source's own noise";
    EXPECT_THAT(system->integrator("attitude-a").error(), HasSubstr("no integrators"));
}

TEST(VesselFile, takes_a_plant_of_the_users_own)
{
    const auto system = loaded({"unit.vessel=null", "unit.plant={A: [[-1, 0.5, 0], [-0.3, -2, 0.1], [0, 0, -1]], B: [[0], [1], [1]]}",
                                "lanes=[{name: a, detector: {poles: [[-3, [-4, 1]]], sigma: [1.0e-4]}}]"});
    ASSERT_TRUE(system) << system.error();
    EXPECT_EQ(system->vessel->c, Eigen::Matrix3d::Identity());
    EXPECT_EQ(system->sensor.source.vessel->model.a(1, 2), 0.1);
    EXPECT_EQ(system->detector("fdi-a")->observers->poles.front().size(), 3U);
}

TEST(VesselFile, lets_the_vessel_be_another_one_than_the_detectors_believe)
{
    const auto system = loaded({"source.vessel={mass: 15.5}"});
    ASSERT_TRUE(system) << system.error();
    EXPECT_NE(system->sensor.source.vessel->model.a, system->vessel->a);
}

TEST(VesselFile, is_refused_for_observers_that_cannot_be)
{
    const auto with_plant = [](const std::string& plant) { return refusal({"unit.vessel=null", "unit.plant=" + plant}); };
    EXPECT_THAT(with_plant("{A: [[1, 2], [3, 4]], B: [[1]]}"), HasSubstr("B must be 2 x 1, got 1 x 1"));
    EXPECT_THAT(with_plant("{A: [[1, 2], [3]], B: [[1], [1]]}"), HasSubstr("unit.plant.A: row 1 must have 2 numbers like the first"));
    EXPECT_THAT(with_plant("{A: [[-1, .nan], [0, -2]], B: [[1], [1]]}"), HasSubstr("A holds a value that is not finite"));
    EXPECT_THAT(with_plant("{A: [[0.5, 0], [0, -2]], B: [[1], [1]]}"), HasSubstr("do not see the plant's pole 0.5"));
    EXPECT_THAT(refusal({"unit.vessel=null", "unit.plant={A: [[-2, 1], [1, -2]], B: [[0], [1]]}",
                         "lanes=[{name: a, detector: {poles: [[-1, -3]]}}]"}),
                HasSubstr("are the plant's own"));
    EXPECT_THAT(with_plant("{B: [[1], [1]]}"), HasSubstr("unit.plant.A"));
    EXPECT_THAT(refusal({"unit.plant={A: [[-1]], B: [[1]]}"}), HasSubstr("either a vessel's coefficients or a plant's matrices"));
    EXPECT_THAT(refusal({"unit.vessel={mass: 3.5, centre_of_mass_x: 2}"}), HasSubstr("mass matrix is singular"));

    const auto with_lane = [](const std::string& detector) { return refusal({"lanes=[{name: a, detector: " + detector + "}]"}); };
    EXPECT_THAT(with_lane("{poles: [[-3, 4]]}"), HasSubstr("pole 4 is not in the left half plane"));
    EXPECT_THAT(with_lane("{poles: [[-3]]}"), HasSubstr("2 observer poles are needed, got 1"));
    EXPECT_THAT(with_lane("{scheme: directional, poles: [[-3, -4], [-3, -3.3658536585365857]]}"), HasSubstr("fault direction undefined"));
    EXPECT_THAT(with_lane("{scheme: directional, poles: [[-3, -4], [-3, -3.9]]}"), HasSubstr("would name the wrong channel"));
    EXPECT_THAT(with_lane("{scheme: luenberger, poles: [[-3, -4]]}"), HasSubstr("there are directional and blind"));
    EXPECT_THAT(with_lane("{method: glt, poles: [[-3, -4]]}"), HasSubstr("lanes[0].detector.method: a vessel's detectors are observers"));
    EXPECT_THAT(with_lane("{scheme: blind}"), HasSubstr("poles"));
    EXPECT_THAT(with_lane("{poles: [[-3, -4]], sigma: [1, 2, 3]}"), HasSubstr("one for each of the 2 channels"));
}

TEST(VesselFile, is_refused_for_what_a_vessel_does_not_have)
{
    EXPECT_THAT(refusal({"voters=[{name: v}]"}), HasSubstr("voters: a vessel's rates give no attitude"));
    EXPECT_THAT(refusal({"lanes=[{name: a, integrator: {}, detector: {poles: [[-3, -4]]}}]"}), HasSubstr("nothing to integrate"));
    EXPECT_THAT(refusal({"expect={no_gap: true}"}), HasSubstr("cannot be met"));
    EXPECT_THAT(refusal({"source.kind=log"}), HasSubstr("no log format holds a rudder"));
    EXPECT_THAT(refusal({"unit.layout=cone-4"}), HasSubstr("unknown key 'layout' in unit"));
    EXPECT_THAT(refusal({"unit.known_input=sail"}), HasSubstr("unknown input 'sail'; there is rudder"));
    EXPECT_THAT(refusal({"source.faults=['axis=5,kind=bias,value=1']"}), HasSubstr("source.faults"));
    EXPECT_THAT(refusal({"unit.channels=[one]"}), HasSubstr("1 names for 2 channels"));
}

TEST(VesselFile, tells_every_mistake_at_once_with_its_place)
{
    const auto file = std::filesystem::path(testing::TempDir()) / "vessel_file_test.yaml";
    std::ofstream(file) << "name: wrong\n"
                           "unit: {id: 1, kind: vessel_rates, known_imput: rudder}\n"
                           "source: {noise: 1.0e-4, rudder: {period_s: 0}}\n"
                           "lanes:\n"
                           "  - name: a\n"
                           "    detector: {poles: [[-3, 4]]}\n";
    const auto system = system::load(file.string(), {.dds = {}, .domain = {}, .processes = {"sensor"}, .set = {}});
    std::filesystem::remove(file);
    ASSERT_FALSE(system);
    EXPECT_THAT(system.error(),
                AllOf(HasSubstr("vessel_file_test.yaml:2:35: unknown key 'known_imput' in unit; did you mean 'known_input'?"),
                      HasSubstr("vessel_file_test.yaml:3:44: source.rudder.period_s: must be above 0"),
                      HasSubstr("vessel_file_test.yaml:6:15: lanes[0].detector: the observer without channel 0"),
                      HasSubstr("problems, nothing started")));
}
