#pragma once

#include "broadcaster.hpp"
#include "quorient/security/token.hpp"
#include "quorient/system/system.hpp"
#include "viewer_server.hpp"
#include "web_server.hpp"

#include <atomic>
#include <optional>
#include <string>
#include <thread>

namespace quorient::monitor {

/// The web side: routes, and the threads that serve them. README.md lists what is served where.
class Site {
public:
    /// Serves from here on. Throws std::runtime_error where the address, or the file of the token, is refused.
    Site(const system::System& system, Exchange& exchange, const Limits& limits = {});
    ~Site();
    Site(const Site&) = delete;
    Site& operator=(const Site&) = delete;

    int port() const { return port_; }

private:
    void route_pages();
    void route_data();
    void route_stream();
    void route_orders();
    httplib::Server::HandlerResponse begin_viewer(const httplib::Request& request, httplib::Response& response);
    bool names_this_host(const httplib::Request& request) const;
    bool is_for_us(const httplib::Request& request) const;
    bool may_order(const httplib::Request& request) const;

    system::MonitorProcess settings_;
    Names names_;
    Limits limits_;
    Exchange& exchange_;
    std::optional<security::Token> token_;
    ViewerServer viewers_;
    Broadcaster broadcaster_;
    std::atomic<std::size_t> streams_{0};
    std::string dygraph_script_;
    std::string dygraph_style_;
    WebServer server_;
    int port_ = 0;
    std::thread thread_;
};

}  // namespace quorient::monitor
