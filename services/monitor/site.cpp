#include "site.hpp"

#include "orders.hpp"
#include "pages.hpp"

#include <fmt/format.h>
#include <strings.h>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

namespace quorient::monitor {
namespace {

constexpr const char* json_type = "application/json";
constexpr std::chrono::milliseconds longest_silence{1000};

/// Where Debian's package libjs-dygraphs puts the chart library.
constexpr const char* dygraph_folder = "/usr/share/javascript/dygraphs/";

std::string file_text(const std::string& path)
{
    std::ifstream file{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
}

/// The page needs nothing but what this server sends. Inline styles are dygraphs'.
httplib::Headers headers()
{
    return {{"Content-Security-Policy",
             "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; img-src 'self' data:; "
             "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
            {"X-Content-Type-Options", "nosniff"},
            {"Referrer-Policy", "no-referrer"},
            {"Cache-Control", "no-store"}};
}

void refuse(httplib::Response& response, int status, const std::string& why)
{
    response.status = status;
    response.set_content(dumped({{"error", why}}) + "\n", json_type);
}

bool is_websocket(const httplib::Request& request)
{
    return ::strcasecmp(request.get_header_value("Upgrade").c_str(), "websocket") == 0;
}

bool is_loopback(const std::string& address)
{
    return address.rfind("127.", 0) == 0;
}

/// Behind a proxy on this host every request arrives from loopback; the proxy says so.
bool is_forwarded(const httplib::Request& request)
{
    return request.has_header("Forwarded") || request.has_header("X-Forwarded-For") || request.has_header("Via");
}

std::optional<security::Token> token_of(const system::System& system)
{
    const auto& monitor = *system.web_monitor;
    if (!monitor.allow_orders || monitor.token_file.empty()) return std::nullopt;
    auto token = security::Token::read(monitor.token_file);
    if (!token) throw std::runtime_error(token.error());
    return std::move(*token);
}

}  // namespace

Site::Site(const system::System& system, Exchange& exchange, const Limits& limits)
    : settings_(*system.web_monitor),
      names_(system),
      limits_(limits),
      exchange_(exchange),
      token_(token_of(system)),
      viewers_(names_),
      broadcaster_(names_, exchange, viewers_),
      dygraph_script_(file_text(std::string{dygraph_folder} + "dygraph.min.js")),
      dygraph_style_(file_text(std::string{dygraph_folder} + "dygraph.min.css")),
      server_(limits)
{
    server_.set_default_headers(headers());
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
        if (is_for_us(request) && is_websocket(request)) return begin_viewer(request, response);
        if (is_for_us(request)) return httplib::Server::HandlerResponse::Unhandled;
        refuse(response, 421, "this server answers to its own address only");
        return httplib::Server::HandlerResponse::Handled;
    });
    server_.set_next_protocol([this](int socket, std::string request, std::string protocol) {
        viewers_.take_over(socket, std::move(request), std::move(protocol));
    });
    route_pages();
    route_data();
    route_stream();
    route_orders();
    port_ = server_.open(settings_.address, static_cast<int>(settings_.port));
    thread_ = std::thread{[this] { server_.listen_after_bind(); }};
    while (!server_.is_running()) std::this_thread::yield();
}

Site::~Site()
{
    broadcaster_.feed().close();
    server_.end_streams();
    server_.stop();
    thread_.join();
}

/// A page of another site could lead a browser here under that site's name (DNS rebinding). On loopback only our own names count.
bool Site::is_for_us(const httplib::Request& request) const
{
    return !is_loopback(settings_.address) || names_this_host(request);
}

bool Site::names_this_host(const httplib::Request& request) const
{
    const auto host = request.get_header_value("Host");
    const auto name = host.substr(0, host.rfind(':'));
    return name == settings_.address || name == "localhost" || name == "127.0.0.1";
}

/// This host needs no token. Whoever a proxy or another site's name has led here counts as another host.
bool Site::may_order(const httplib::Request& request) const
{
    if (is_loopback(request.remote_addr) && !is_forwarded(request) && names_this_host(request)) return true;
    return token_ && token_->admits(request.get_header_value("Authorization"));
}

httplib::Server::HandlerResponse Site::begin_viewer(const httplib::Request& request, httplib::Response& response)
{
    const auto protocol = ViewerServer::chosen_protocol(request.get_header_value("Sec-WebSocket-Protocol"));
    if (!ViewerServer::may_connect(request.get_header_value("Origin"), settings_.address))
        refuse(response, 403, "pages of other sites may not connect");
    else if (!protocol) refuse(response, 400, "expected Sec-WebSocket-Protocol: foxglove.websocket.v1 or foxglove.sdk.v1");
    else WebServer::go_on_with(*protocol);
    return httplib::Server::HandlerResponse::Handled;
}

void Site::route_pages()
{
    for (const auto& page : pages()) {
        server_.Get(std::string{page.path}, [&page](const httplib::Request&, httplib::Response& response) {
            response.set_content(page.text.data(), page.text.size(), std::string{page.type});
        });
    }
    const auto installed = [this](const char* path, const std::string& text, const char* type) {
        server_.Get(path, [&text, type](const httplib::Request&, httplib::Response& response) {
            if (text.empty()) return refuse(response, 404, "the package libjs-dygraphs is not installed: there are no plots");
            response.set_content(text, type);
        });
    };
    installed("/dygraph.js", dygraph_script_, "text/javascript");
    installed("/dygraph.css", dygraph_style_, "text/css");
}

void Site::route_data()
{
    server_.Get("/healthz", [this](const httplib::Request&, httplib::Response& response) {
        if (!broadcaster_.alive()) return refuse(response, 503, "the monitor's DDS side does not answer");
        response.set_content("{\"status\":\"ok\"}\n", json_type);
    });
    server_.Get("/metrics", [this](const httplib::Request&, httplib::Response& response) {
        broadcaster_.metrics().set_server({streams_, server_.refused(), viewers_.viewers(), viewers_.dropped()});
        response.set_content(broadcaster_.metrics().text(), "text/plain; version=0.0.4");
    });
    server_.Get("/state", [this](const httplib::Request&, httplib::Response& response) {
        const auto state = broadcaster_.state();
        if (!state) return refuse(response, 503, "nothing has been received yet");
        response.set_content(*state + "\n", json_type);
    });
    server_.Get("/history", [this](const httplib::Request&, httplib::Response& response) {
        response.set_content(broadcaster_.history().text() + "\n", json_type);
    });
    server_.Get("/events", [this](const httplib::Request&, httplib::Response& response) {
        response.set_content(*broadcaster_.events() + "\n", json_type);
    });
}

void Site::route_stream()
{
    server_.Get("/stream", [this](const httplib::Request&, httplib::Response& response) {
        if (++streams_ > limits_.streams) {
            --streams_;
            response.set_header("Retry-After", "5");
            return refuse(response, 503, fmt::format("{} pages are open, which is the most", limits_.streams));
        }
        auto number = std::make_shared<std::uint64_t>(0);
        response.set_chunked_content_provider(
            "text/event-stream",
            [this, number](std::size_t, httplib::DataSink& sink) {
                const auto next = broadcaster_.feed().wait_behind(*number, longest_silence);
                if (broadcaster_.feed().closed()) return false;
                std::string text = *number == 0 ? "retry: 1000\n\n" : next.text ? "" : ":\n\n";
                if (next.joined) text += "event: all_events\ndata: " + *broadcaster_.events() + "\n\n";
                if (!text.empty() && !sink.write(text.data(), text.size())) return false;
                *number = next.number;
                return !next.text || sink.write(next.text->data(), next.text->size());
            },
            [this](bool) { --streams_; });
    });
}

void Site::route_orders()
{
    server_.Post("/order", [this](const httplib::Request& request, httplib::Response& response) {
        if (!settings_.allow_orders) return refuse(response, 403, "this monitor was started without --allow-orders");
        if (!may_order(request))
            return refuse(response, 403, token_ ? "another host needs the token of this monitor for an order"
                                                : "orders are accepted from this host alone; monitor.token_file lets others send them");
        // A form of another site can be sent here by a browser, but not with this type.
        if (request.get_header_value("Content-Type") != json_type) return refuse(response, 415, "an order is application/json");
        const auto order = order_from(request.body);
        if (!order) return refuse(response, 400, order.error());
        if (!exchange_.order(*order)) return refuse(response, 503, "too many orders wait already");
        response.status = 202;
        response.set_content("{\"status\":\"accepted; the services' answers are events\"}\n", json_type);
    });
}

}  // namespace quorient::monitor
