// The lines of `quorient status` about services that do not get their processor time.

#include "report/starvation.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <gtest/gtest.h>

namespace quorient::report {

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

/// Two seconds of a running service.
Interval service(const char* name, std::uint32_t id, ServiceRole role, double rate_hz)
{
    Interval interval;
    for (auto* status : {&interval.first, &interval.latest}) {
        copy_text(name, status->name);
        status->service = id;
        status->role = octet(role);
        status->state = octet(ServiceState::running);
        status->published = 1000;
    }
    interval.latest.wall_time_ns = 2 * second_ns;
    interval.latest.published += static_cast<std::uint64_t>(2 * rate_hz);
    return interval;
}

TEST(Starvation, is_not_said_of_services_that_keep_up)
{
    const std::vector services{service("sensor", 101, ServiceRole::sensor, 1000), service("fdi-a", 111, ServiceRole::detector, 998),
                               service("attitude-a", 112, ServiceRole::integrator, 1002), service("voter-1", 102, ServiceRole::voter, 960)};
    EXPECT_TRUE(find_starving(services, {}).empty());
}

TEST(Starvation, names_the_service_that_gives_out_fewer_frames_than_the_sensor_sends)
{
    const std::vector services{service("sensor", 101, ServiceRole::sensor, 1000), service("fdi-a", 111, ServiceRole::detector, 1000),
                               service("attitude-a", 112, ServiceRole::integrator, 640)};
    const auto starving = find_starving(services, {});
    ASSERT_EQ(starving.size(), 1U);
    EXPECT_EQ(starving_text(starving).find("STARVING: attitude-a gives 640 of 1000 frames per second: it gets too little processor time"), 0U)
        << starving_text(starving);
}

TEST(Starvation, is_not_said_of_a_frame_that_only_one_of_two_counts_has)
{
    auto sensor = service("sensor", 101, ServiceRole::sensor, 0);
    auto detector = service("fdi-a", 111, ServiceRole::detector, 0);
    for (auto* each : {&sensor, &detector}) each->latest.wall_time_ns = second_ns / 2;
    sensor.latest.published = sensor.first.published + 11;
    detector.latest.published = detector.first.published + 9;
    EXPECT_TRUE(find_starving(std::vector{sensor, detector}, {}).empty());
    detector.latest.published = detector.first.published + 8;
    EXPECT_EQ(find_starving(std::vector{sensor, detector}, {}).size(), 1U);
}

TEST(Starvation, is_judged_by_the_quickest_service_where_no_sensor_answers)
{
    const std::vector services{service("fdi-a", 111, ServiceRole::detector, 200), service("fdi-b", 113, ServiceRole::detector, 100)};
    const auto starving = find_starving(services, {});
    ASSERT_EQ(starving.size(), 1U);
    EXPECT_EQ(starving.front().service, "fdi-b");
}

HealthEvent overloaded(std::uint32_t service, std::int64_t wall_time_ns, Severity severity)
{
    HealthEvent event;
    event.source = service;
    event.wall_time_ns = wall_time_ns;
    event.code = octet(EventCode::overloaded);
    event.severity = octet(severity);
    return event;
}

TEST(Starvation, of_a_service_that_leaves_frames_out_says_so)
{
    const std::vector services{service("sensor", 101, ServiceRole::sensor, 1000), service("voter-1", 102, ServiceRole::voter, 250)};
    const std::vector begun{overloaded(102, 5, Severity::warning_high)};
    const auto text = starving_text(find_starving(services, begun));
    EXPECT_EQ(text.find("STARVING: voter-1 gives 250 of 1000 frames per second: it is overloaded and leaves frames out"), 0U) << text;
    const std::vector over{overloaded(102, 9, Severity::info), overloaded(102, 5, Severity::warning_high)};
    EXPECT_EQ(starving_text(find_starving(services, over)).find("leaves frames out"), std::string::npos);
    const std::vector of_another{overloaded(103, 5, Severity::warning_high)};
    EXPECT_EQ(starving_text(find_starving(services, of_another)).find("leaves frames out"), std::string::npos);
}

TEST(Starvation, is_not_judged_across_a_restart_of_the_service)
{
    auto restarted = service("voter-1", 102, ServiceRole::voter, 250);
    restarted.latest.process = restarted.first.process + 1;
    EXPECT_TRUE(find_starving(std::vector{service("sensor", 101, ServiceRole::sensor, 1000), restarted}, {}).empty());
}

TEST(Starvation, is_not_said_of_a_service_that_has_not_begun)
{
    auto starting = service("fdi-a", 111, ServiceRole::detector, 0);
    starting.latest.state = octet(ServiceState::ready);
    EXPECT_TRUE(find_starving(std::vector{service("sensor", 101, ServiceRole::sensor, 1000), starting}, {}).empty());
}

TEST(Starvation, is_not_said_of_a_voter_that_gave_out_its_first_frame_meanwhile)
{
    auto voter = service("voter-1", 102, ServiceRole::voter, 0);
    voter.first.published = 0;
    voter.latest.published = 1;
    EXPECT_TRUE(find_starving(std::vector{service("sensor", 101, ServiceRole::sensor, 1000), voter}, {}).empty());
}

}  // namespace

}  // namespace quorient::report
