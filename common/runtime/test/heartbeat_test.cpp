#include "quorient/runtime/heartbeat.hpp"

#include <gtest/gtest.h>
#include <cstdlib>
#include <fstream>

namespace quorient::runtime {
namespace {

/// A run directory of its own for each test.
class HeartbeatTest : public testing::Test {
protected:
    HeartbeatTest()
    {
        std::filesystem::create_directories(folder);
        ::setenv("QUORIENT_RUN_DIR", folder.c_str(), 1);
    }
    ~HeartbeatTest() override
    {
        ::unsetenv("QUORIENT_RUN_DIR");
        std::filesystem::remove_all(folder);
    }

    std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / (std::string("heartbeat_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(HeartbeatTest, says_whose_it_is_and_what_was_handled)
{
    auto heartbeat = Heartbeat::open({"voter 1", "the boat's gyros", 42, 7});
    ASSERT_TRUE(heartbeat);
    heartbeat->beat(123'456'789'012, 17);
    const auto beats = read_heartbeats();
    ASSERT_EQ(beats.size(), 1U);
    EXPECT_EQ(beats[0].owner.service, "voter 1");
    EXPECT_EQ(beats[0].owner.system, "the boat's gyros");
    EXPECT_EQ(beats[0].owner.domain, 42U);
    EXPECT_EQ(beats[0].owner.unit, 7U);
    EXPECT_EQ(beats[0].steady_ns, 123'456'789'012);
    EXPECT_EQ(beats[0].frames, 17U);
}

TEST_F(HeartbeatTest, of_another_system_is_kept_apart_from_one_of_the_same_name)
{
    auto own = Heartbeat::open({"voter-1", "own", 42, 1});
    auto other = Heartbeat::open({"voter-1", "other", 43, 1});
    ASSERT_TRUE(own && other);
    other->beat(5, 5);
    own->beat(9, 9);
    other->beat(6, 6);
    const auto beats = read_heartbeats();
    ASSERT_EQ(beats.size(), 2U);
    EXPECT_EQ(beats[0].owner.system, "own");
    EXPECT_EQ(beats[0].frames, 9U);
    EXPECT_EQ(beats[1].owner.system, "other");
    EXPECT_EQ(beats[1].frames, 6U);
}

TEST_F(HeartbeatTest, of_a_service_that_has_handled_nothing_yet_counts_no_frame)
{
    const auto heartbeat = Heartbeat::open({"fdi-a", "demo", 42, 1});
    ASSERT_EQ(read_heartbeats().size(), 1U);
    EXPECT_EQ(read_heartbeats()[0].frames, 0U);
}

TEST_F(HeartbeatTest, keeps_its_owner_when_numbers_grow_to_their_full_width)
{
    auto heartbeat = Heartbeat::open({"fdi-a", "demo", 4'294'967'295U, 4'294'967'295U});
    heartbeat->beat(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::uint64_t>::max());
    heartbeat->beat(1, 2);
    ASSERT_EQ(read_heartbeats().size(), 1U);
    EXPECT_EQ(read_heartbeats()[0].frames, 2U);
    EXPECT_EQ(read_heartbeats()[0].owner.system, "demo");
}

TEST_F(HeartbeatTest, is_not_taken_from_a_file_of_another_kind)
{
    std::ofstream(folder / "voter-1.heartbeat") << "12 13\n";
    std::ofstream(folder / "empty.heartbeat");
    EXPECT_TRUE(read_heartbeats().empty());
}

}  // namespace
}  // namespace quorient::runtime
