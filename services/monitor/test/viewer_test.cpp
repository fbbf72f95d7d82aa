#include "viewer_channels.hpp"
#include "viewer_server.hpp"

#include "ticks.hpp"

#include <gtest/gtest.h>
#include <cmath>

using namespace quorient;
using namespace quorient::monitor;
using Json = nlohmann::json;

namespace {

/// A tick of the demo's unit in which G2 is isolated.
class ViewerMessages : public testing::Test {
protected:
    ViewerMessages() : system_(monitor::test::demo()), names_(system_), collector_(system_)
    {
        collector_.on_description(monitor::test::description());
        auto voted = monitor::test::voted(5, 0b10);
        voted.attitude = {std::cos(0.25), 0, 0, std::sin(0.25)};
        voted_ = voted;
        auto verdict = monitor::test::verdict(5, VerdictState::isolated, 0b10);
        verdict.residual[1] = -3e-6;
        collector_.on_verdict(verdict, 1);
        collector_.on_event(monitor::test::event(1, "G2 isolated"));
    }

    const Tick& tick()
    {
        collector_.on_voted(voted_, 1);
        return collector_.tick(1, 2'500'000'000);
    }

    std::vector<Json> messages(ViewerChannel channel) { return viewer_messages(channel, tick(), names_); }

    system::System system_;
    Names names_;
    Collector collector_;
    VotedAttitude voted_;
};

/// Members of the message that the schema does not have, at any depth.
std::vector<std::string> unknown_members(const Json& message, const Json& schema)
{
    std::vector<std::string> unknown;
    if (message.is_array()) {
        for (const auto& entry : message)
            for (auto& name : unknown_members(entry, schema["items"])) unknown.push_back(name);
        return unknown;
    }
    if (!message.is_object()) return unknown;
    for (const auto& [name, value] : message.items()) {
        if (!schema["properties"].contains(name)) unknown.push_back(name);
        else
            for (auto& inner : unknown_members(value, schema["properties"][name])) unknown.push_back(name + "." + inner);
    }
    return unknown;
}

}  // namespace

TEST_F(ViewerMessages, are_what_their_schemas_say)
{
    const auto channels = advertised_channels();
    ASSERT_EQ(channels.size(), viewer_channels);
    for (std::size_t id = 0; id < viewer_channels; ++id) {
        EXPECT_EQ(channels[id]["id"], id);
        EXPECT_EQ(channels[id]["encoding"], "json");
        EXPECT_EQ(channels[id]["schemaEncoding"], "jsonschema");
        const auto schema = Json::parse(channels[id]["schema"].get<std::string>());
        const auto made = messages(static_cast<ViewerChannel>(id));
        ASSERT_EQ(made.size(), 1u) << channels[id];
        ASSERT_TRUE(made.front().is_object()) << made.front();
        EXPECT_EQ(unknown_members(made.front(), schema), std::vector<std::string>{}) << made.front();
        EXPECT_EQ(made.front().size(), schema["properties"].size()) << made.front();
    }
}

TEST_F(ViewerMessages, turn_the_body_in_the_reference_frame_by_the_voted_attitude)
{
    const auto transform = messages(ViewerChannel::transform).front();
    EXPECT_EQ(transform["parent_frame_id"], "reference");
    EXPECT_EQ(transform["child_frame_id"], "body");
    EXPECT_EQ(transform["rotation"]["w"], std::cos(0.25));
    EXPECT_EQ(transform["rotation"]["z"], std::sin(0.25));
    EXPECT_EQ(transform["timestamp"]["sec"], 2);
    EXPECT_EQ(transform["timestamp"]["nsec"], 500'000'000);
    EXPECT_NEAR(messages(ViewerChannel::attitude).front()["yaw_deg"].get<double>(), 0.5 * 180 / M_PI, 1e-6);
}

TEST_F(ViewerMessages, have_no_attitude_where_the_output_is_lost)
{
    voted_.level = octet(VoteLevel::lost);
    EXPECT_TRUE(messages(ViewerChannel::transform).empty());
    EXPECT_TRUE(messages(ViewerChannel::attitude).empty());
    EXPECT_EQ(messages(ViewerChannel::level).front()["level"], "LOST");
}

TEST_F(ViewerMessages, name_the_isolated_axis_in_the_lane_that_isolated_it_and_no_other)
{
    const auto axes = messages(ViewerChannel::axes).front()["axes"];
    ASSERT_FALSE(axes.empty());
    for (const auto& entry : axes) {
        const bool is_it = entry["name"] == "G2" && entry["lane"] == "a";
        EXPECT_EQ(entry["state"] == "isolated", is_it) << entry;
        if (is_it) {
            EXPECT_EQ(entry["least_residual"], -3e-6);
        }
    }
}

TEST(ViewerServer, answers_to_both_names_of_the_protocol_and_to_no_other)
{
    EXPECT_EQ(ViewerServer::chosen_protocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
    EXPECT_EQ(ViewerServer::chosen_protocol("chat, foxglove.sdk.v1 ,foxglove.websocket.v1"), "foxglove.sdk.v1");
    for (const char* other : {"", "foxglove", ",,,", "foxglove.websocket.v2"}) EXPECT_EQ(ViewerServer::chosen_protocol(other), std::nullopt) << other;
}

TEST(ViewerServer, lets_programs_and_its_own_host_connect_but_no_page_of_another_site)
{
    for (const char* good : {"", "file://", "https://app.foxglove.dev", "http://localhost:8080", "http://127.0.0.1:8080", "http://192.0.2.7"})
        EXPECT_TRUE(ViewerServer::may_connect(good, "192.0.2.7")) << good;
    for (const char* bad : {"null", "http://example.org", "https://app.foxglove.dev.example.org", "http://localhost.example.org",
                            "http://127.0.0.1.example.org:80"})
        EXPECT_FALSE(ViewerServer::may_connect(bad, "192.0.2.7")) << bad;
}
