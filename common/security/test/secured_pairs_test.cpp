// Every topic, between processes of either vendor, in either order of starting: signed, and encrypted. Either is a process of its own, since
// Cyclone DDS has one set of permissions for all participants of a process.

#include "../../bus/test/random_message.hpp"
#include "exchange.hpp"
#include "quorient/security/authority.hpp"
#include "temporary_directory.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <csignal>
#include <set>
#include <tuple>

namespace quorient::security {

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto patience = std::chrono::seconds{20};
constexpr std::int64_t hour_s = 3600;

/// A process that is ended with its owner.
class Child {
public:
    explicit Child(std::vector<std::string> command)
    {
        std::array<int, 2> channel{};
        if (::pipe(channel.data()) != 0) throw std::runtime_error("no pipe");
        std::vector<char*> words;
        for (auto& word : command) words.push_back(word.data());
        words.push_back(nullptr);
        process_ = ::fork();
        if (process_ == 0) {
            ::dup2(channel[1], STDOUT_FILENO);
            ::execv(words.front(), words.data());
            ::_exit(127);
        }
        ::close(channel[1]);
        output_ = channel[0];
    }
    ~Child()
    {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
        ::close(output_);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Until it has said its first word. @returns false where it ended without.
    bool until_here() const
    {
        char first = 0;
        return ::read(output_, &first, 1) == 1;
    }

private:
    pid_t process_ = 0;
    int output_ = -1;
};

/// Fast DDS 3, of which the library is called fastdds, exchanges nothing with Cyclone DDS under security (KNOWN_ISSUES.md).
bool can_match(Vendor writing, Vendor reading)
{
    return writing == reading || std::string_view{QUORIENT_FASTDDS} != "fastdds";
}

enum class Order { writer_first, reader_first };

class SecuredPairs : public testing::TestWithParam<std::tuple<Vendor, Vendor, Order, bus::SecurityLevel>> {
protected:
    SecuredPairs()
    {
        const auto now = std::chrono::system_clock::now().time_since_epoch();
        const auto now_s = std::chrono::duration_cast<std::chrono::seconds>(now).count();
        auto authority = Authority::open_or_make(directory.path(), now_s).value();
        const auto level = std::get<3>(GetParam());
        EXPECT_TRUE(authority.govern(domain, level, now_s));
        const auto topics = access_of(Role::monitor).subscribes;
        EXPECT_TRUE(authority.issue({"writer", Role::sensor, {topics, {}}}, now_s, hour_s));
        EXPECT_TRUE(authority.issue({"reader", Role::monitor, {{}, topics}}, now_s, hour_s));
    }

    const TemporaryDirectory directory;
    const std::uint32_t domain = 100 + static_cast<std::uint32_t>(::getpid() % 100);
};

/// A subscription to each topic, and which of them have brought the message that was meant.
class Ear {
public:
    Ear(bus::Bus& bus, std::uint64_t seed)
    {
        const auto subscribe = [&](const auto& topic) {
            using Message = typename std::decay_t<decltype(topic)>::Message;
            auto subscription = std::make_shared<bus::Subscription<Message>>(bus.subscribe(topic));
            const auto expected = bus::message_for(topic, seed);
            missing_.insert(topic.spec.name);
            takes_.push_back([this, subscription, expected, name = topic.spec.name] {
                Message message;
                while (subscription->take(message)) compare(expected, message, name);
            });
        };
        std::apply([&](const auto&... topic) { (subscribe(topic), ...); }, bus::topics::all);
    }

    const std::set<std::string>& missing()
    {
        for (const auto& take : takes_) take();
        return missing_;
    }

private:
    template <class Message>
    void compare(const Message& expected, const Message& received, const char* topic)
    {
        std::apply(
            [&](const auto&... field) {
                ([&] { EXPECT_EQ(expected.*(field.member), received.*(field.member)) << topic << "." << field.name; }(), ...);
            },
            Fields<Message>::all);
        missing_.erase(topic);
    }

    std::vector<std::function<void()>> takes_;
    std::set<std::string> missing_;
};

TEST_P(SecuredPairs, carry_every_topic_whoever_starts_first)
{
    const auto [writing, reading, order, level] = GetParam();
    if (!can_match(writing, reading)) GTEST_SKIP() << "Fast DDS 3 exchanges nothing with Cyclone DDS under security";
    const auto seed = static_cast<std::uint64_t>(::getpid());
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto join_as_reader = [&, reading = reading, level = level] { return join(directory.path(), "reader", reading, domain, level); };
    std::unique_ptr<bus::Bus> bus;
    if (order == Order::reader_first) bus = join_as_reader();
    const Child writer({QUORIENT_PEER, directory.path().string(), std::string{bus::to_string(writing)}, std::to_string(domain),
                        std::string{bus::to_string(level)}, std::to_string(seed)});
    ASSERT_TRUE(writer.until_here());
    if (!bus) bus = join_as_reader();

    Ear ear(*bus, seed);
    const auto deadline = Clock::now() + patience;
    while (!ear.missing().empty() && Clock::now() < deadline) bus->wait(5'000'000);
    for (const auto& topic : ear.missing()) ADD_FAILURE() << topic << ": nothing received";
}

std::string name_of(const testing::TestParamInfo<SecuredPairs::ParamType>& pair)
{
    const auto [writing, reading, order, level] = pair.param;
    return std::string{bus::to_string(writing)} + "_to_" + std::string{bus::to_string(reading)} +
           (order == Order::writer_first ? "_writer_first_" : "_reader_first_") + std::string{bus::to_string(level)};
}

INSTANTIATE_TEST_SUITE_P(Loopback, SecuredPairs,
                         testing::Combine(testing::Values(Vendor::fastdds, Vendor::cyclonedds),
                                          testing::Values(Vendor::fastdds, Vendor::cyclonedds),
                                          testing::Values(Order::writer_first, Order::reader_first),
                                          testing::Values(bus::SecurityLevel::encrypt, bus::SecurityLevel::sign)),
                         name_of);

}  // namespace

}  // namespace quorient::security
