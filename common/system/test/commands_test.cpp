#include "quorient/system/system.hpp"

#include <gmock/gmock.h>
#include <string>
#include <vector>

namespace quorient::system {

namespace {

using testing::HasSubstr;

const char* const live_source = "source={kind: ros2_imu, rate_hz: 100, noise_rad: 1.0e-5, imus: [{topic: /a}, {topic: /b}]}";
const char* const six_axes = "lanes=[{name: a, detector: {method: subset}}]";

tl::expected<System, std::string> load_demo(std::vector<std::string> set)
{
    Overrides overrides;
    overrides.set = std::move(set);
    return load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml", overrides);
}

runtime::OrderSettings orders_of(std::vector<std::string> set)
{
    const auto system = load_demo(std::move(set));
    EXPECT_TRUE(system) << system.error();
    return system ? system->sensor.process.node.orders : runtime::OrderSettings{};
}

TEST(Commands, are_all_allowed_to_a_simulation)
{
    const auto orders = orders_of({});
    EXPECT_TRUE(orders.inject && orders.readmit && orders.reset);
}

TEST(Commands, inject_is_refused_by_default_for_a_live_source)
{
    const auto orders = orders_of({"unit.layout=null", live_source, six_axes});
    EXPECT_FALSE(orders.inject);
    EXPECT_TRUE(orders.readmit && orders.reset);
    EXPECT_TRUE(orders_of({"unit.layout=null", live_source, six_axes, "commands={inject: allowed}"}).inject);
}

TEST(Commands, hold_for_every_process_of_the_unit)
{
    const auto system = load_demo({"commands={readmit: refused, reset: refused}"});
    ASSERT_TRUE(system) << system.error();
    for (const auto& lane : system->lanes) {
        EXPECT_FALSE(lane.detector.process.node.orders.readmit);
        EXPECT_FALSE(lane.integrator.process.node.orders.reset);
    }
    EXPECT_TRUE(system->sensor.process.node.orders.inject);
}

TEST(Commands, with_an_unknown_word_are_an_error)
{
    const auto system = load_demo({"commands={inject: sometimes}"});
    ASSERT_FALSE(system);
    EXPECT_THAT(system.error(), HasSubstr("there are allowed and refused"));
}

}  // namespace

}  // namespace quorient::system
