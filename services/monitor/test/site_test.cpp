#include "site.hpp"

#include "ticks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <stdexcept>
#include <vector>

using namespace quorient;
using namespace quorient::monitor;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

namespace {

/// A site on a free port of loopback, fed by a collector of the test's own.
class Serving : public testing::Test {
protected:
    explicit Serving(Limits limits = {}, const std::vector<std::string>& set = {"monitor.port=0"})
        : system_(monitor::test::demo(set)), collector_(system_), site_(system_, exchange_, limits)
    {
        collector_.on_description(monitor::test::description());
    }

    httplib::Client client()
    {
        httplib::Client client{"127.0.0.1", site_.port()};
        client.set_read_timeout(5);
        return client;
    }

    /// The response to a request. A thread is free only some time after its last response: a connection that found none is tried again.
    httplib::Result response_to(const std::string& path)
    {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{10};
        for (;;) {
            auto response = client().Get(path);
            if (response) return response;
            if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error("no response to " + path);
        }
    }

    void hand_over()
    {
        wall_ns_ += 100'000'000;
        const auto& tick = collector_.tick(wall_ns_, wall_ns_);
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{5};
        while (!exchange_.offer(tick)) {
            ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "the web side does not take ticks";
            std::this_thread::yield();
        }
        collector_.begin();
    }

    /// Frames of a cluster, handed over, until the web side shows them.
    Json state_after(AxisMask isolated)
    {
        collector_.on_voted(monitor::test::voted(++sequence_, isolated), wall_ns_);
        collector_.on_verdict(monitor::test::verdict(sequence_, isolated ? VerdictState::isolated : VerdictState::healthy, isolated), wall_ns_);
        hand_over();
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{5};
        for (;;) {
            if (const auto got = client().Get("/state"); got && got->status == 200) {
                auto state = Json::parse(got->body);
                if (state["attitude"].is_object() && state["attitude"]["sequence"] == sequence_) return state;
            }
            if (std::chrono::steady_clock::now() > deadline) return {};
        }
    }

    system::System system_;
    Exchange exchange_;
    Collector collector_;
    Site site_;
    std::int64_t wall_ns_ = 1'000'000'000;
    std::uint64_t sequence_ = 0;
};

struct WithOrders : Serving {
    WithOrders() : Serving({}, {"monitor.port=0", "monitor.allow_orders=true"}) {}
};

const std::string secret = "0123456789abcdef0123456789ABCDEF";

/// The file of a token, for as long as the test lasts.
struct TokenFile {
    TokenFile()
    {
        if (!::mkdtemp(folder.data())) throw std::runtime_error("no temporary directory");
        std::ofstream{path()} << secret << "\n";
        std::filesystem::permissions(path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    }
    ~TokenFile() { std::filesystem::remove_all(folder); }
    std::string path() const { return folder + "/token"; }
    std::string folder = testing::TempDir() + "monitor-XXXXXX";
};

struct WithToken : TokenFile, Serving {
    WithToken() : Serving({}, {"monitor.port=0", "monitor.allow_orders=true", "monitor.token_file=" + path()}) {}

    /// The answer to an order with these headers.
    int status(httplib::Headers headers) { return client().Post("/order", headers, R"({"action":"clear"})", "application/json")->status; }
};

struct WithFewThreads : Serving {
    WithFewThreads()
        : Serving({.threads = 16,
                   .streams = 2,
                   .request_patience = std::chrono::milliseconds{300},
                   .write_patience = std::chrono::milliseconds{300}})
    {
    }
};

int connected(int port)
{
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    timeval patience{5, 0};
    ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    return socket;
}

void send_text(int socket, const std::string& text)
{
    ASSERT_EQ(::send(socket, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
}

/// Until the server closes.
std::string received(int socket)
{
    std::string all;
    char bytes[4096];
    for (ssize_t count = 0; (count = ::recv(socket, bytes, sizeof bytes, 0)) > 0;) all.append(bytes, static_cast<std::size_t>(count));
    return all;
}

}  // namespace

TEST_F(Serving, the_state_names_the_isolated_axis_and_no_other)
{
    const auto healthy = state_after(0);
    for (const auto& axis : healthy["axes"]) EXPECT_EQ(axis["state"], "healthy") << axis;
    const auto faulty = state_after(0b0010);
    ASSERT_EQ(faulty["axes"].size(), 4u);
    for (const auto& axis : faulty["axes"]) EXPECT_EQ(axis["state"], axis["name"] == "G2" ? "isolated" : "healthy") << axis;
    EXPECT_EQ(faulty["level"], "FULL");
    EXPECT_EQ(faulty["lanes"][0]["standing"], "primary");
}

TEST_F(Serving, health_depends_on_the_ticks_of_the_dds_side)
{
    EXPECT_EQ(response_to("/healthz")->status, 503) << "before the first tick";
    state_after(0);
    EXPECT_EQ(response_to("/healthz")->status, 200);
}

TEST_F(Serving, metrics_count_each_isolation_once)
{
    state_after(0);
    state_after(0b0010);
    state_after(0b0010);
    const auto metrics = response_to("/metrics")->body;
    EXPECT_THAT(metrics, HasSubstr("quorient_isolations_total{unit=\"1\",axis=\"G2\",lane=\"a\"} 1\n"));
    EXPECT_THAT(metrics, HasSubstr("quorient_isolations_total{unit=\"1\",axis=\"G1\",lane=\"a\"} 0\n"));
    EXPECT_THAT(metrics, HasSubstr("quorient_axis_state{unit=\"1\",axis=\"G2\",state=\"isolated\"} 1\n"));
    EXPECT_THAT(metrics, HasSubstr("quorient_level{unit=\"1\",state=\"FULL\"} 1\n"));
    EXPECT_THAT(metrics, HasSubstr("quorient_voted_frames_total{unit=\"1\"} 3\n"));
}

TEST_F(Serving, a_stream_begins_with_all_events_and_goes_on_with_the_state)
{
    collector_.on_event(monitor::test::event(1, "isolates G2"));
    state_after(0);
    std::string text;
    auto streaming = std::async(std::launch::async, [&] {
        client().Get("/stream", [&](const char* bytes, std::size_t size) {
            text.append(bytes, size);
            return text.find("event: state") == std::string::npos;
        });
    });
    while (streaming.wait_for(std::chrono::milliseconds{1}) != std::future_status::ready) hand_over();
    EXPECT_THAT(text, HasSubstr("event: all_events\ndata: [{"));
    EXPECT_THAT(text, HasSubstr("isolates G2"));
}

TEST_F(Serving, text_of_a_peer_that_is_no_utf8_does_no_harm)
{
    collector_.on_event(monitor::test::event(1, "\xff\xfe bad"));
    state_after(0);
    EXPECT_THAT(response_to("/events")->body, HasSubstr(" bad"));
}

TEST_F(Serving, orders_are_refused_unless_allowed)
{
    const auto refused = client().Post("/order", R"({"action":"clear"})", "application/json");
    EXPECT_EQ(refused->status, 403);
    EXPECT_FALSE(exchange_.next_order());
}

TEST_F(WithOrders, an_order_reaches_the_dds_side_as_it_was_given)
{
    const auto accepted = client().Post("/order", R"({"action":"inject","fault":"axis=2,kind=bias,value=0.05,start=0"})", "application/json");
    ASSERT_EQ(accepted->status, 202) << accepted->body;
    const auto order = exchange_.next_order();
    ASSERT_TRUE(order);
    EXPECT_EQ(action_of(*order), CommandAction::inject);
    EXPECT_EQ(order->axes, 0b0100u);
    EXPECT_EQ(order->value, 0.05);
}

/// What the server sees of another host here: a proxy's header, or a name that is not this host's.
const httplib::Headers from_elsewhere{{"X-Forwarded-For", "192.0.2.7"}};

TEST_F(WithOrders, from_elsewhere_are_refused_while_there_is_no_token)
{
    using httplib::Headers;
    for (const Headers& headers : {from_elsewhere, Headers{{"Forwarded", "for=192.0.2.7"}}, Headers{{"Via", "1.1 proxy"}},
                                   Headers{{"X-Forwarded-For", "192.0.2.7"}, {"Authorization", "Bearer " + secret}},
                                   Headers{{"X-Forwarded-For", "192.0.2.7"}, {"Authorization", "Bearer "}}}) {
        const auto refused = client().Post("/order", headers, R"({"action":"clear"})", "application/json");
        EXPECT_EQ(refused->status, 403);
        EXPECT_THAT(refused->body, HasSubstr("from this host alone"));
    }
    EXPECT_FALSE(exchange_.next_order());
}

TEST_F(WithToken, an_order_from_elsewhere_is_accepted_with_the_token_and_with_no_other)
{
    auto headers = from_elsewhere;
    EXPECT_EQ(status(headers), 403);
    for (const auto& wrong : {"Bearer", "Bearer 0123456789abcdef0123456789ABCDEE", "Basic 0123456789abcdef0123456789ABCDEF"}) {
        headers = from_elsewhere;
        headers.emplace("Authorization", wrong);
        EXPECT_EQ(status(headers), 403) << wrong;
    }
    EXPECT_FALSE(exchange_.next_order());
    headers = from_elsewhere;
    headers.emplace("Authorization", "Bearer " + secret);
    EXPECT_EQ(status(headers), 202);
    EXPECT_TRUE(exchange_.next_order());
}

TEST_F(WithToken, this_host_needs_none)
{
    EXPECT_EQ(status({}), 202);
    EXPECT_TRUE(exchange_.next_order());
}

TEST_F(WithToken, is_shown_nowhere)
{
    const auto state = state_after(0);
    EXPECT_EQ(state["token"], true);
    std::string all = state.dump() + system_.configuration;
    for (const char* path : {"/", "/events", "/metrics", "/history"}) all += response_to(path)->body;
    all += client().Post("/order", from_elsewhere, "{}", "application/json")->body;
    EXPECT_THAT(all, Not(HasSubstr(secret)));
}

/// Served on every network, a request may carry any name: one led here by DNS rebinding is not this host's.
TEST(Site, takes_orders_under_the_name_of_this_host_alone_where_it_serves_every_network)
{
    const auto system = monitor::test::demo({"monitor.port=0", "monitor.allow_orders=true", "monitor.address=0.0.0.0"});
    Exchange exchange;
    const Site site{system, exchange};
    httplib::Client client{"127.0.0.1", site.port()};
    const auto status = [&](const std::string& host) {
        return client.Post("/order", {{"Host", host}}, R"({"action":"clear"})", "application/json")->status;
    };
    EXPECT_EQ(status("evil.example:8080"), 403);
    EXPECT_FALSE(exchange.next_order());
    EXPECT_EQ(status("localhost:8080"), 202);
    EXPECT_TRUE(exchange.next_order());
}

TEST_F(WithOrders, says_what_is_wrong_with_an_order)
{
    for (const char* bad : {"", "[", R"({"action":"explode"})", R"({"action":"readmit","axes":[99]})", R"({"action":"reset","attitude":[1,1,0,0]})",
                            R"({"action":"inject","fault":"axis=1,kind=magic"})", R"({"action":7})"}) {
        const auto refused = client().Post("/order", bad, "application/json");
        EXPECT_EQ(refused->status, 400) << bad;
        EXPECT_THAT(refused->body, HasSubstr("error")) << bad;
    }
    EXPECT_EQ(client().Post("/order", R"({"action":"clear"})", "text/plain")->status, 415) << "what a form of another site can send";
    EXPECT_FALSE(exchange_.next_order());
}

TEST_F(Serving, a_request_under_the_name_of_another_site_is_not_answered)
{
    state_after(0);
    const auto refused = client().Get("/state", {{"Host", "evil.example:8080"}});
    EXPECT_EQ(refused->status, 421);
    EXPECT_THAT(refused->body, Not(HasSubstr("level")));
    EXPECT_EQ(client().Get("/state", {{"Host", "localhost:8080"}})->status, 200);
}

TEST_F(Serving, a_second_server_on_the_same_port_is_refused_with_the_reason)
{
    auto system = monitor::test::demo({"monitor.port=" + std::to_string(site_.port())});
    Exchange other;
    try {
        const Site second{system, other};
        FAIL() << "it shares the port";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("Address already in use"));
    }
}

TEST_F(WithFewThreads, connections_beyond_the_threads_are_closed_and_later_ones_are_served)
{
    state_after(0);
    std::vector<int> silent;
    for (int i = 0; i < 200; ++i) silent.push_back(connected(site_.port()));
    EXPECT_EQ(received(silent.back()), "") << "closed without an answer";
    for (const int socket : silent) ::close(socket);
    const auto metrics = response_to("/metrics")->body;
    EXPECT_GE(std::stoul(metrics.substr(metrics.find("refused_total{unit=\"1\"} ") + 24)), 1u);
}

TEST_F(WithFewThreads, a_page_beyond_the_streams_is_told_to_come_later)
{
    state_after(0);
    std::vector<int> pages;
    for (int i = 0; i < 2; ++i) {
        pages.push_back(connected(site_.port()));
        send_text(pages.back(), "GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n");
        char first = 0;
        ASSERT_EQ(::recv(pages.back(), &first, 1, 0), 1);
    }
    const auto refused = response_to("/stream");
    EXPECT_EQ(refused->status, 503);
    EXPECT_TRUE(refused->has_header("Retry-After"));
    for (const int socket : pages) ::close(socket);
}

TEST_F(WithFewThreads, a_request_that_does_not_end_is_given_up)
{
    const int slow = connected(site_.port());
    send_text(slow, "GET /state HTTP/1.1\r\nX: ");
    EXPECT_THAT(received(slow), Not(HasSubstr("200"))) << "closed within its patience, which the socket's own time-out of 5 s bounds";
    ::close(slow);
}

TEST_F(WithFewThreads, garbage_gets_an_error_or_nothing_and_the_server_goes_on)
{
    state_after(0);
    for (const std::string& garbage :
         {std::string(1000, '\0'), std::string("\x16\x03\x01\x02", 4) + std::string(500, 'x') + "\r\n\r\n",
          std::string("GET /../../etc/passwd HTTP/1.1\r\n\r\n"), std::string("GET ") + std::string(20000, 'a') + " HTTP/1.1\r\n\r\n"}) {
        const int socket = connected(site_.port());
        ::send(socket, garbage.data(), garbage.size(), MSG_NOSIGNAL);
        EXPECT_THAT(received(socket), Not(HasSubstr("200 OK")));
        ::close(socket);
    }
    EXPECT_EQ(response_to("/healthz")->status, 200);
}

TEST_F(WithFewThreads, a_client_that_never_reads_is_closed_and_holds_up_nobody)
{
    state_after(0);
    const int deaf = connected(site_.port());
    const int small = 1;
    ::setsockopt(deaf, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    send_text(deaf, "GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const auto streams = [this] {
        const auto text = response_to("/metrics")->body;
        return text[text.find("quorient_monitor_streams{unit=\"1\"} ") + 35];
    };
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{10};
    while (streams() != '1') ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "the stream has not begun";
    while (streams() != '0') {
        ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "the client is still served";
        for (int i = 0; i < 20; ++i) {
            collector_.on_event(monitor::test::event(1, std::string(150, 'x')));
            hand_over();
        }
    }
    ::close(deaf);
    EXPECT_EQ(response_to("/healthz")->status, 200);
}
