#include "quorient/runtime/heartbeat_owner.hpp"

#include <gtest/gtest.h>
#include <fcntl.h>
#include <unistd.h>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <thread>

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

/// Calls `read` for half a second while another thread repeats `write`.
void read_beside(const std::function<void()>& write, const std::function<void()>& read)
{
    std::atomic<bool> over = false;
    std::thread writer([&] {
        while (!over) write();
    });
    for (const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds{500};
         std::chrono::steady_clock::now() < end && !testing::Test::HasFailure();)
        read();
    over = true;
    writer.join();
}

TEST_F(HeartbeatTest, never_shows_a_beat_that_was_not_written)
{
    auto heartbeat = opened("voter-1", {"demo", 42, 1});
    std::uint64_t written = 199'999'000;
    heartbeat->beat(static_cast<std::int64_t>(written * 1000), written);
    std::uint64_t last = 0;
    read_beside(
        [&] {
            ++written;
            heartbeat->beat(static_cast<std::int64_t>(written * 1000), written);
        },
        [&] {
            const auto pulses = read_pulses();
            ASSERT_EQ(pulses.size(), 1U);
            ASSERT_EQ(pulses[0].beat.steady_ns, static_cast<std::int64_t>(pulses[0].beat.frames * 1000));
            ASSERT_GE(pulses[0].beat.frames, last);
            last = pulses[0].beat.frames;
        });
    EXPECT_GT(last, 199'999'000U);
}

TEST_F(HeartbeatTest, that_is_half_written_is_read_again)
{
    auto heartbeat = opened("voter-1", {"demo", 42, 1});
    const auto path = folder / "voter-1.42.1.heartbeat";
    const auto text_after = [&](std::int64_t steady_ns) {
        heartbeat->beat(steady_ns, 7);
        std::ifstream file{path};
        return std::string{std::istreambuf_iterator<char>(file), {}};
    };
    const auto before = text_after(199'999'999'999);
    const auto after = text_after(200'000'000'010);
    const int file = ::open(path.c_str(), O_WRONLY);
    ASSERT_GE(file, 0);
    const auto write_in_two = [&](const std::string& text) {
        constexpr std::size_t half = 12;  // within the first number
        EXPECT_EQ(::pwrite(file, text.data(), half, 0), static_cast<ssize_t>(half));
        std::this_thread::yield();
        EXPECT_EQ(::pwrite(file, text.data() + half, text.size() - half, half), static_cast<ssize_t>(text.size() - half));
        std::this_thread::sleep_for(std::chrono::microseconds{200});
    };
    unsigned whole = 0;
    read_beside(
        [&] {
            write_in_two(before);
            write_in_two(after);
        },
        [&] {
            const auto pulses = read_pulses();
            if (pulses.empty()) return;  // on a busy machine the writer may stand in the middle for longer than a reader tries
            ++whole;
            ASSERT_TRUE(pulses[0].beat.steady_ns == 199'999'999'999 || pulses[0].beat.steady_ns == 200'000'000'010) << pulses[0].beat.steady_ns;
        });
    ::close(file);
    EXPECT_GT(whole, 0U);
}

TEST_F(HeartbeatTest, of_a_service_that_starts_again_is_never_missing)
{
    const HeartbeatOwner owner{"demo", 42, 1};
    auto first = opened("voter-1", owner);
    first->beat(5, 5);
    read_beside([&] { opened("voter-1", owner); },
                [] {
                    ASSERT_EQ(read_pulses().size(), 1U);
                });
}

TEST_F(HeartbeatTest, of_another_system_in_its_place_leaves_nothing_of_the_longer_name)
{
    opened("voter-1", {"a system with a long name", 42, 1});
    const auto heartbeat = opened("voter-1", {"demo", 42, 1});
    ASSERT_EQ(read_pulses().size(), 1U);
    EXPECT_EQ(read_pulses()[0].owner.system, "demo");
}

TEST_F(HeartbeatTest, of_an_earlier_release_is_read_without_its_sum)
{
    std::ofstream(folder / "voter-1.42.1.heartbeat") << "                 123                   17\n42 1\nvoter-1\ndemo\n";
    ASSERT_EQ(read_pulses().size(), 1U);
    EXPECT_EQ(read_pulses()[0].beat.frames, 17U);
}

}  // namespace
}  // namespace quorient::runtime
