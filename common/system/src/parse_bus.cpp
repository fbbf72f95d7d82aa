#include "parse_bus.hpp"

namespace quorient::system {

void parse_process(runtime::Section& section, const Overrides& overrides, ProcessSettings& process)
{
    std::string word;
    section.text("dds", word);
    if (!word.empty()) {
        if (const auto vendor = bus::vendor_from(word)) process.bus.vendor = *vendor;
        else section.problem("dds", vendor.error());
    }
    std::string transport_word;
    section.text("transport", transport_word);
    if (!transport_word.empty()) {
        if (const auto transport = bus::transport_from(transport_word)) process.bus.transport = *transport;
        else section.problem("transport", transport.error());
    }
    std::string shared_memory_word;
    section.text("shared_memory", shared_memory_word);
    if (!shared_memory_word.empty()) {
        if (const auto choice = bus::shared_memory_from(shared_memory_word)) process.bus.shared_memory = *choice;
        else section.problem("shared_memory", choice.error());
    }
    section.text("interface", process.bus.interface);
    if (process.bus.interface == "any") process.bus.interface.clear();
    section.texts("peers", process.bus.peers);
    section.whole("participants_per_host", process.bus.participants_per_host, 1, 60);
    section.boolean("security", process.bus.security);
    section.boolean("spin", process.spin);
    section.boolean("stamps", process.node.stamps);
    std::uint32_t priority = static_cast<std::uint32_t>(process.realtime.priority);
    section.whole("priority", priority, 0, 99);
    process.realtime.priority = static_cast<int>(priority);
    section.boolean("lock_memory", process.realtime.lock_memory);
    std::vector<double> processors;
    section.numbers("processors", processors, {.lowest = 0, .highest = 1023});
    if (section.has("processors")) process.realtime.processors.assign(processors.begin(), processors.end());
    if (overrides.dds) {
        process.bus.vendor = *overrides.dds;
        // The other vendor's shared memory does not come along.
        if (process.bus.transport == Transport::shared_memory || process.bus.transport == Transport::iceoryx)
            process.bus.transport = Transport::udp;
    }
    if (overrides.domain) process.bus.domain = *overrides.domain;
}

void check_bus(runtime::Section& section, const ProcessSettings& process)
{
    for (const auto& problem : bus::problems(process.bus)) section.problem("dds", problem);
}

}  // namespace quorient::system
