#include "quorient/runtime/heartbeat_owner.hpp"

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

    /// As one process opens it.
    static std::optional<Heartbeat> opened(const std::string& service, const HeartbeatOwner& owner)
    {
        set_heartbeat_owner(owner);
        return Heartbeat::open(service);
    }

    std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / (std::string("heartbeat_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(HeartbeatTest, says_whose_it_is_and_what_was_handled)
{
    auto heartbeat = opened("voter 1", {"the boat's gyros", 42, 7});
    ASSERT_TRUE(heartbeat);
    heartbeat->beat(123'456'789'012, 17);
    const auto pulses = read_pulses();
    ASSERT_EQ(pulses.size(), 1U);
    EXPECT_EQ(pulses[0].service, "voter 1");
    EXPECT_EQ(pulses[0].owner.system, "the boat's gyros");
    EXPECT_EQ(pulses[0].owner.domain, 42U);
    EXPECT_EQ(pulses[0].owner.unit, 7U);
    EXPECT_EQ(pulses[0].beat.steady_ns, 123'456'789'012);
    EXPECT_EQ(pulses[0].beat.frames, 17U);
}

TEST_F(HeartbeatTest, of_another_system_is_kept_apart_from_one_of_the_same_name)
{
    auto own = opened("voter-1", {"own", 42, 1});
    auto other = opened("voter-1", {"other", 43, 1});
    ASSERT_TRUE(own && other);
    other->beat(5, 5);
    own->beat(9, 9);
    other->beat(6, 6);
    const auto pulses = read_pulses();
    ASSERT_EQ(pulses.size(), 2U);
    EXPECT_EQ(pulses[0].owner.system, "own");
    EXPECT_EQ(pulses[0].beat.frames, 9U);
    EXPECT_EQ(pulses[1].owner.system, "other");
    EXPECT_EQ(pulses[1].beat.frames, 6U);
}

TEST_F(HeartbeatTest, of_a_service_that_has_handled_nothing_yet_counts_no_frame)
{
    const auto heartbeat = opened("fdi-a", {"demo", 42, 1});
    ASSERT_EQ(read_pulses().size(), 1U);
    EXPECT_EQ(read_pulses()[0].beat.frames, 0U);
}

TEST_F(HeartbeatTest, keeps_its_owner_when_numbers_grow_to_their_full_width)
{
    auto heartbeat = opened("fdi-a", {"demo", 4'294'967'295U, 4'294'967'295U});
    heartbeat->beat(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::uint64_t>::max());
    heartbeat->beat(1, 2);
    ASSERT_EQ(read_pulses().size(), 1U);
    EXPECT_EQ(read_pulses()[0].beat.frames, 2U);
    EXPECT_EQ(read_pulses()[0].owner.system, "demo");
}

TEST_F(HeartbeatTest, is_not_taken_from_a_file_of_another_kind)
{
    std::ofstream(folder / "voter-1.heartbeat") << "12 13\n";
    std::ofstream(folder / "empty.heartbeat");
    EXPECT_TRUE(read_pulses().empty());
}

}  // namespace
}  // namespace quorient::runtime
