// What a service manager receives: the datagrams of sd_notify(3), read from its end of the socket.

#include "quorient/runtime/service_manager.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace quorient::runtime {

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t ms_ns = 1'000'000;

class ServiceManagerTest : public testing::Test {
protected:
    ServiceManagerTest()
    {
        const std::string name = "quorient-service-manager-test-" + std::to_string(::getpid());
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path + 1, name.data(), name.size());
        socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
        const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
        EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), length), 0);
        ::setenv("NOTIFY_SOCKET", ("@" + name).c_str(), 1);
        // The watchdog is the process's, so the tests share it: each lives later than the one before.
        static std::int64_t start_ns = 0;
        now_ns_ = start_ns += 1'000'000 * ms_ns;
    }

    ~ServiceManagerTest() override
    {
        ::close(socket_);
        for (const char* variable : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(variable);
    }

    std::vector<std::string> received() const
    {
        std::vector<std::string> all;
        std::array<char, 256> text{};
        for (ssize_t size = 0; (size = ::recv(socket_, text.data(), text.size(), 0)) >= 0;) all.emplace_back(text.data(), size);
        return all;
    }

    std::int64_t now_ns_ = 0;

private:
    int socket_ = -1;
};

TEST_F(ServiceManagerTest, learns_once_that_a_service_is_ready_and_that_it_stops)
{
    auto service = ServiceManager::from_environment();
    ASSERT_TRUE(service);
    EXPECT_THAT(received(), IsEmpty());
    service->ready();
    service->ready();
    EXPECT_THAT(received(), ElementsAre("READY=1"));
    service->stopping();
    EXPECT_THAT(received(), ElementsAre("STOPPING=1"));
}

TEST_F(ServiceManagerTest, takes_a_process_for_ready_when_all_its_services_are)
{
    auto one = ServiceManager::from_environment();
    auto other = ServiceManager::from_environment();
    ASSERT_TRUE(one && other);
    one->ready();
    EXPECT_THAT(received(), IsEmpty());
    other->ready();
    EXPECT_THAT(received(), ElementsAre("READY=1"));
}

TEST_F(ServiceManagerTest, has_its_watchdog_fed_by_frames_at_half_its_time)
{
    ::setenv("WATCHDOG_USEC", "200000", 1);
    auto service = ServiceManager::from_environment();
    ASSERT_TRUE(service);
    std::size_t fed = 0;
    for (int i = 0; i < 100; ++i) {
        service->frame_handled(now_ns_ += 10 * ms_ns);
        fed += received().size();
    }
    EXPECT_EQ(fed, 10U) << "every 100 ms of one second";
}

TEST_F(ServiceManagerTest, of_a_long_watchdog_receives_one_datagram_a_second)
{
    ::setenv("WATCHDOG_USEC", "60000000", 1);
    auto service = ServiceManager::from_environment();
    ASSERT_TRUE(service);
    for (int i = 0; i < 1000; ++i) service->frame_handled(now_ns_ += 5 * ms_ns);
    EXPECT_EQ(received().size(), 5U);
}

TEST_F(ServiceManagerTest, sees_the_watchdog_starve_when_one_service_of_a_process_handles_no_frames)
{
    ::setenv("WATCHDOG_USEC", "200000", 1);
    auto one = ServiceManager::from_environment();
    auto other = ServiceManager::from_environment();
    ASSERT_TRUE(one && other);
    for (int i = 0; i < 100; ++i) one->frame_handled(now_ns_ += 10 * ms_ns);
    EXPECT_THAT(received(), IsEmpty());
    other->frame_handled(now_ns_);
    EXPECT_THAT(received(), ElementsAre("WATCHDOG=1"));
}

TEST_F(ServiceManagerTest, without_a_watchdog_or_with_another_processs_is_not_fed)
{
    auto without = ServiceManager::from_environment();
    ASSERT_TRUE(without);
    without->frame_handled(now_ns_ += 10'000 * ms_ns);
    ::setenv("WATCHDOG_USEC", "200000", 1);
    ::setenv("WATCHDOG_PID", "1", 1);
    auto of_another = ServiceManager::from_environment();
    ASSERT_TRUE(of_another);
    without->frame_handled(now_ns_);
    of_another->frame_handled(now_ns_ += 10'000 * ms_ns);
    EXPECT_THAT(received(), IsEmpty());
}

TEST_F(ServiceManagerTest, is_absent_where_none_listens)
{
    ::setenv("NOTIFY_SOCKET", "@quorient-nobody-listens-here", 1);
    EXPECT_FALSE(ServiceManager::from_environment());
    ::setenv("NOTIFY_SOCKET", "relative/path", 1);
    EXPECT_FALSE(ServiceManager::from_environment());
    ::unsetenv("NOTIFY_SOCKET");
    EXPECT_FALSE(ServiceManager::from_environment());
}

}  // namespace

}  // namespace quorient::runtime
