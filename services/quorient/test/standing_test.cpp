#include "report/standing.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <gtest/gtest.h>

namespace quorient::report {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr std::int64_t now_ns = 1000 * second_ns;

/// Four gyros at 200 Hz, two lanes, two voters, all well.
Standing healthy()
{
    Standing standing;
    auto& description = standing.description.emplace();
    description.axis_count = description.instrument_count = 4;
    description.interval_s = 0.005;
    for (std::uint8_t axis = 0; axis < 4; ++axis) {
        description.instrument[axis] = axis;
        copy_text("G" + std::to_string(axis + 1), description.instrument_name[axis]);
    }
    auto& voted = standing.voted.emplace();
    voted.level = octet(VoteLevel::full);
    voted.voter = 2;
    voted.primary_lane = 1;
    voted.vouching_mask = 0b11;
    for (const std::uint32_t lane : {1U, 2U}) {
        auto& verdict = standing.verdicts[lane];
        verdict.sequence = 4000;
        verdict.state = octet(VerdictState::healthy);
        verdict.detectable_remaining = 1;
    }
    standing.voters = {{1, "voter-1"}, {2, "spare"}};
    standing.lanes = {{1, "a"}, {2, "b"}};
    standing.level_since_ns = now_ns - 25 * second_ns;
    return standing;
}

TEST(Standing, of_a_healthy_unit_is_good)
{
    EXPECT_EQ(
        standing_text(healthy(), now_ns),
        "GOOD: attitude FULL since 25 s, from spare, primary lane a, 2 lanes vouch; no axis is out; 4 axes left, 1 further fault can be detected");
}

TEST(Standing, names_what_is_out_and_since_when_as_the_description_does)
{
    auto standing = healthy();
    standing.voted->isolated_mask = 0b10;
    standing.verdicts[1].isolated_mask = 0b10;
    standing.verdicts[1].excluded_from[1] = 2320;
    standing.verdicts[1].detectable_remaining = 0;
    EXPECT_EQ(
        standing_text(standing, now_ns),
        "GOOD: attitude FULL since 25 s, from spare, primary lane a, 2 lanes vouch; out: G2 since 8.4 s; 3 axes left, no further fault can be detected");
    const auto json = standing_json(standing, now_ns);
    EXPECT_EQ(json["good"], true);
    EXPECT_EQ(json["out"][0]["name"], "G2");
    EXPECT_NEAR(json["out"][0]["since_s"].get<double>(), 8.4, 1e-9);
}

TEST(Standing, is_not_good_where_no_majority_vouches)
{
    auto standing = healthy();
    standing.voted->level = octet(VoteLevel::single);
    standing.voted->vouching_mask = 0b1;
    EXPECT_TRUE(standing_text(standing, now_ns).starts_with("DOUBTFUL: attitude SINGLE since 25 s, from spare, primary lane a, 1 lane vouches;"));
    standing.voted->level = octet(VoteLevel::lost);
    EXPECT_TRUE(standing_text(standing, now_ns).starts_with("BAD: attitude LOST"));
    EXPECT_EQ(standing_json(standing, now_ns)["good"], false);
    standing.voted.reset();
    EXPECT_TRUE(standing_text(standing, now_ns).starts_with("BAD: no voter owns the output;"));
}

TEST(Standing, is_not_bad_before_the_output_could_be_received)
{
    auto standing = healthy();
    standing.voted.reset();
    standing.output_is_due = false;
    EXPECT_TRUE(standing_text(standing, now_ns).starts_with("NOTHING YET: voters run"));
    EXPECT_TRUE(standing_json(standing, now_ns)["good"].is_null());
}

TEST(Standing, of_a_unit_without_voters_is_that_of_its_detectors)
{
    auto standing = healthy();
    standing.voted.reset();
    standing.voters.clear();
    EXPECT_EQ(standing_text(standing, now_ns), "detectors only: HEALTHY; no axis is out; 4 axes left, 1 further fault can be detected");
    EXPECT_EQ(standing_text({}, now_ns), "NOTHING: no voter and no detector sends anything");
}

}  // namespace
}  // namespace quorient::report
