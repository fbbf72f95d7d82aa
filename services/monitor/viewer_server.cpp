#include "viewer_server.hpp"

#include "viewer_channels.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <set>
#include <thread>
#include <vector>

namespace quorient::monitor {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using Json = nlohmann::json;
using Error = boost::system::error_code;

namespace {

constexpr std::array<std::string_view, 2> protocols{"foxglove.sdk.v1", "foxglove.websocket.v1"};

constexpr int send_buffer_bytes = 32 * 1024;  // what waits there is old already
constexpr std::size_t header_bytes = 13;  // operation 1, subscription, time: all little-endian
enum class StatusLevel { info, warning, error };

using Body = std::shared_ptr<const std::string>;

/// A message to a viewer: text, or the data of a subscription.
struct Outgoing {
    Body body;
    std::array<std::uint8_t, header_bytes> header{};
    bool binary = false;
};

std::array<std::uint8_t, header_bytes> data_header(std::uint32_t subscription, std::int64_t wall_time_ns)
{
    std::array<std::uint8_t, header_bytes> header{1};
    for (std::size_t i = 0; i < 4; ++i) header[1 + i] = static_cast<std::uint8_t>(subscription >> (8 * i));
    for (std::size_t i = 0; i < 8; ++i) header[5 + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(wall_time_ns) >> (8 * i));
    return header;
}

/// What all viewers share; only `watched`, `viewers` and `dropped` are seen by other threads.
struct Shared {
    ViewerLimits limits;
    Body greeting;
    Body channels;
    std::array<std::atomic<std::size_t>, viewer_channels> watched{};
    std::atomic<std::size_t> viewers{0};
    std::atomic<std::uint64_t> dropped{0};
};

/// One viewer. Everything here runs on the server's thread.
class Viewer : public std::enable_shared_from_this<Viewer> {
public:
    Viewer(asio::ip::tcp::socket socket, Shared& shared) : stream_(std::move(socket)), shared_(shared) { ++shared_.viewers; }

    ~Viewer()
    {
        for (const auto& subscription : subscription_)
            if (subscription) --shared_.watched[static_cast<std::size_t>(&subscription - subscription_.data())];
        --shared_.viewers;
    }

    void begin(const std::string& request, const std::string& protocol)
    {
        auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
        timeout.handshake_timeout = std::chrono::seconds{5};  // also how long a viewer may take to confirm the close
        timeout.idle_timeout = shared_.limits.silence;
        timeout.keep_alive_pings = true;
        stream_.set_option(timeout);
        stream_.set_option(websocket::stream_base::decorator(
            [protocol](websocket::response_type& response) { response.set(beast::http::field::sec_websocket_protocol, protocol); }));
        stream_.read_message_max(shared_.limits.request_bytes);
        // Parsed here, because Beast takes no more than 1536 octets of a request that it is to parse itself.
        beast::http::request_parser<beast::http::empty_body> parser;
        parser.eager(true);
        parser.header_limit(static_cast<std::uint32_t>(request.size()) + 1);
        Error malformed;
        parser.put(asio::buffer(request), malformed);
        if (malformed || !parser.is_done()) return;
        stream_.async_accept(parser.get(), [self = shared_from_this()](Error error) {
            if (error) return;
            self->open_ = true;
            self->send({self->shared_.greeting});
            self->send({self->shared_.channels});
            self->read();
        });
    }

    bool is_open() const { return open_; }

    void send_data(std::size_t channel, const Body& body, std::int64_t wall_time_ns)
    {
        if (!subscription_[channel]) return;
        if (waiting_.size() >= shared_.limits.waiting) ++shared_.dropped;
        else send({body, data_header(*subscription_[channel], wall_time_ns), true});
    }

    void end()
    {
        open_ = false;
        Error ignored;
        beast::get_lowest_layer(stream_).socket().close(ignored);
    }

private:
    void read()
    {
        stream_.async_read(incoming_, [self = shared_from_this()](Error error, std::size_t) {
            if (error) return self->end();
            const bool understood = self->stream_.got_text() && self->handle(beast::buffers_to_string(self->incoming_.data()));
            if (!understood) return self->refuse();
            self->incoming_.consume(self->incoming_.size());
            self->read();
        });
    }

    void refuse()
    {
        open_ = false;
        stream_.async_close({websocket::close_code::policy_error, "expected a JSON object with an op"},
                            [self = shared_from_this()](Error) { self->end(); });
    }

    /// @returns false for what is no message of the protocol.
    bool handle(const std::string& text)
    {
        const auto message = Json::parse(text, nullptr, false);
        if (!message.is_object() || !message.contains("op") || !message["op"].is_string()) return false;
        const auto operation = message["op"].get<std::string>();
        if (operation == "subscribe") return subscribe(message.value("subscriptions", Json()));
        if (operation == "unsubscribe") return unsubscribe(message.value("subscriptionIds", Json()));
        report(StatusLevel::warning, fmt::format("this server does not offer '{}'", operation.substr(0, 40)));
        return true;
    }

    bool subscribe(const Json& subscriptions)
    {
        if (!subscriptions.is_array()) return false;
        for (const auto& its : subscriptions) {
            if (!its.is_object() || !is_id(its.value("id", Json())) || !is_id(its.value("channelId", Json()))) return false;
            const auto channel = its["channelId"].get<std::uint32_t>();
            const auto id = its["id"].get<std::uint32_t>();
            if (channel >= viewer_channels) report(StatusLevel::error, fmt::format("there is no channel {}", channel));
            else if (subscription_[channel] || std::ranges::find(subscription_, id) != subscription_.end())
                report(StatusLevel::error, fmt::format("subscription {} or channel {} is in use", id, channel));
            else {
                subscription_[channel] = id;
                ++shared_.watched[channel];
            }
        }
        return true;
    }

    bool unsubscribe(const Json& ids)
    {
        if (!ids.is_array()) return false;
        for (const auto& id : ids) {
            if (!is_id(id)) return false;
            const auto found = std::ranges::find(subscription_, id.get<std::uint32_t>());
            if (found == subscription_.end()) continue;
            found->reset();
            --shared_.watched[static_cast<std::size_t>(found - subscription_.begin())];
        }
        return true;
    }

    static bool is_id(const Json& value) { return value.is_number_unsigned() && value.get<std::uint64_t>() <= UINT32_MAX; }

    void report(StatusLevel level, const std::string& message)
    {
        if (waiting_.size() >= shared_.limits.waiting) ++shared_.dropped;
        else send({std::make_shared<const std::string>(dumped({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}}))});
    }

    void send(Outgoing outgoing)
    {
        if (!open_) return;
        waiting_.push_back(std::move(outgoing));
        if (waiting_.size() == 1) write();
    }

    void write()
    {
        const auto& next = waiting_.front();
        stream_.binary(next.binary);
        const std::array<asio::const_buffer, 2> parts{asio::buffer(next.header.data(), next.binary ? header_bytes : 0), asio::buffer(*next.body)};
        stream_.async_write(parts, [self = shared_from_this()](Error error, std::size_t) {
            if (error) return self->end();
            self->waiting_.pop_front();
            if (self->open_ && !self->waiting_.empty()) self->write();
        });
    }

    websocket::stream<beast::tcp_stream> stream_;
    Shared& shared_;
    beast::flat_buffer incoming_;
    std::deque<Outgoing> waiting_;  // the first one is being written
    std::array<std::optional<std::uint32_t>, viewer_channels> subscription_{};
    bool open_ = false;
};

bool begins_with(std::string_view text, std::string_view beginning)
{
    return text.substr(0, beginning.size()) == beginning;
}

}  // namespace

struct ViewerServer::Implementation {
    explicit Implementation(const Names& its_names, const ViewerLimits& limits) : names(its_names)
    {
        shared.limits = limits;
        shared.greeting = std::make_shared<const std::string>(dumped({{"op", "serverInfo"},
                                                                      {"name", "Quorient: " + names.system},
                                                                      {"capabilities", Json::array()},
                                                                      {"metadata", {{"unit", std::to_string(names.unit)}}}}));
        shared.channels = std::make_shared<const std::string>(dumped({{"op", "advertise"}, {"channels", advertised_channels()}}));
        thread = std::thread([this] { context.run(); });
    }

    void add(int socket, const std::string& request, const std::string& protocol)
    {
        std::erase_if(viewers, [](const auto& viewer) { return viewer.expired(); });
        Error error;
        asio::ip::tcp::socket connection(context);
        connection.assign(asio::ip::tcp::v4(), socket, error);
        if (error) ::close(socket);
        if (error || viewers.size() >= shared.limits.viewers) return;  // the socket closes with `connection`
        connection.set_option(asio::socket_base::send_buffer_size(send_buffer_bytes), error);
        const auto viewer = std::make_shared<Viewer>(std::move(connection), shared);
        viewers.push_back(viewer);
        viewer->begin(request, protocol);
    }

    void send(std::size_t channel, const Body& body, std::int64_t wall_time_ns)
    {
        for (const auto& weak : viewers)
            if (const auto viewer = weak.lock(); viewer && viewer->is_open()) viewer->send_data(channel, body, wall_time_ns);
    }

    const Names& names;
    Shared shared;
    asio::io_context context{1};
    asio::executor_work_guard<asio::io_context::executor_type> work{context.get_executor()};
    std::vector<std::weak_ptr<Viewer>> viewers;
    std::thread thread;
};

ViewerServer::ViewerServer(const Names& names, const ViewerLimits& limits) : its_(std::make_unique<Implementation>(names, limits)) {}

ViewerServer::~ViewerServer()
{
    asio::post(its_->context, [this] {
        for (const auto& weak : its_->viewers)
            if (const auto viewer = weak.lock()) viewer->end();
        its_->work.reset();
        its_->context.stop();
    });
    its_->thread.join();
}

std::optional<std::string> ViewerServer::chosen_protocol(std::string_view offered)
{
    while (!offered.empty()) {
        const auto end = std::min(offered.find(','), offered.size());
        auto name = offered.substr(0, end);
        offered.remove_prefix(std::min(end + 1, offered.size()));
        name.remove_prefix(std::min(name.find_first_not_of(" \t"), name.size()));
        name = name.substr(0, name.find_last_not_of(" \t") + 1);
        if (std::ranges::find(protocols, name) != protocols.end()) return std::string(name);
    }
    return std::nullopt;
}

bool ViewerServer::may_connect(std::string_view origin, std::string_view own_address)
{
    if (origin == "null") return false;  // what a browser sends for a page that hides where it comes from
    const bool is_web_page = begins_with(origin, "http://") || begins_with(origin, "https://");
    if (!is_web_page || origin == "https://app.foxglove.dev") return true;
    auto host = origin.substr(origin.find("//") + 2);
    host = host.substr(0, host.find(':'));
    return host == "localhost" || host == "127.0.0.1" || host == own_address;
}

void ViewerServer::take_over(int socket, std::string request, std::string protocol)
{
    asio::post(its_->context, [this, socket, request = std::move(request), protocol = std::move(protocol)] { its_->add(socket, request, protocol); });
}

void ViewerServer::publish(const Tick& tick)
{
    for (std::size_t channel = 0; channel < viewer_channels; ++channel) {
        if (its_->shared.watched[channel] == 0) continue;
        for (const auto& message : viewer_messages(static_cast<ViewerChannel>(channel), tick, its_->names))
            asio::post(its_->context, [this, channel, body = std::make_shared<const std::string>(dumped(message)), time_ns = tick.wall_time_ns] {
                its_->send(channel, body, time_ns);
            });
    }
}

std::size_t ViewerServer::viewers() const
{
    return its_->shared.viewers;
}

std::uint64_t ViewerServer::dropped() const
{
    return its_->shared.dropped;
}

}  // namespace quorient::monitor
