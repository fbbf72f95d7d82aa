#include "monitor.hpp"

#include "process.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <array>
#include <algorithm>
#include <string_view>

namespace quorient::system {

using namespace configuration;

namespace {

bool is_address(const std::string& text)
{
    in_addr address{};
    return ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

Rows<MonitorSection> address_row()
{
    const auto read = [](Section& section, MonitorSection& monitor) {
        section.text("address", monitor.address);
        if (is_address(monitor.address)) return;
        section.problem("address",
                        fmt::format("'{}' is no IPv4 address; 127.0.0.1 serves this host alone, 0.0.0.0 every network", monitor.address));
    };
    return own<MonitorSection>({.name = "address", .form = "text", .sentence = "IPv4 address of the page; 0.0.0.0 = every network."}, read,
                               [](const MonitorSection& monitor) { return to_node(monitor.address); });
}

Rows<MonitorSection> token_row()
{
    const auto read = [](Section& section, MonitorSection& monitor) { section.text("token_file", monitor.token_file); };
    const auto write = [](const MonitorSection& monitor) {
        return monitor.token_file.empty() ? YAML::Node{YAML::NodeType::Undefined} : to_node(monitor.token_file);
    };
    return own<MonitorSection>({.name = "token_file",
                                .form = "text",
                                .otherwise = "none",
                                .sentence = "File with the token that other hosts need for orders, mode 0600; counts from the folder of the system "
                                            "file. Without it orders are taken from this host alone."},
                               read, write);
}

/// Its own defaults hold for these keys, the whole file's for the others.
constexpr std::array<std::string_view, 5> own_defaults{"transport", "spin", "priority", "lock_memory", "processors"};

Rows<MonitorSection> joining_rows()
{
    auto rows = all_of(&MonitorSection::process, process_rows());
    for (auto& row : rows)
        if (std::ranges::find(own_defaults, std::string_view{row.key.name}) == own_defaults.end()) row.key.otherwise = "as the whole file";
    return rows;
}

}  // namespace

const Table<MonitorSection>& monitor_table()
{
    static const Table<MonitorSection> table{
        "A process that shows the running system: a page, its state as JSON, figures for Prometheus.",
        {value({.name = "name", .sentence = "Name of its process, up to 31 characters."}, &MonitorSection::name), joining_rows(),
         address_row(),
         value({.name = "port", .bounds = settings::Bounds{.lowest = 0, .highest = 65'535}, .sentence = "TCP port of the page; 0 = any free one."},
               &MonitorSection::port),
         value({.name = "allow_orders", .sentence = "The page may send orders: faults, readmissions and resets."},
               &MonitorSection::allow_orders),
         token_row()}};
    return table;
}

void prepare_monitor(const ProcessSettings& file, MonitorSection& monitor)
{
    monitor.process = file;
    monitor.process.realtime = {};
    monitor.process.spin = false;
    monitor.process.bus.transport = Transport::udp;
}

}  // namespace quorient::system
