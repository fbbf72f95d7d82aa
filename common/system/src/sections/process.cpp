#include "process.hpp"

#include "security.hpp"

#include <array>

namespace quorient::system {

using namespace configuration;

namespace {

constexpr std::array<settings::Setting<runtime::RealtimeSettings>, 2> realtime{{
    {"priority",
     &runtime::RealtimeSettings::priority,
     "",
     {.lowest = 0, .highest = 99},
     "Real-time priority (SCHED_FIFO); 0 = ordinary scheduling."},
    {"lock_memory", &runtime::RealtimeSettings::lock_memory, "", {}, "Keep the process's memory from being swapped out."},
}};

Rows<bus::Settings> interface_row()
{
    const auto read = [](Section& section, bus::Settings& settings) {
        section.text("interface", settings.interface);
        if (settings.interface == "any") settings.interface.clear();
    };
    const auto write = [](const bus::Settings& settings) {
        return to_node(settings.interface.empty() ? std::string{"any"} : settings.interface);
    };
    return own<bus::Settings>({.name = "interface",
                               .form = "text",
                               .sentence = "Network interface by its name, an address of it, or its subnet; `any` leaves the choice to "
                                           "the vendor."},
                              read, write);
}

Table<bus::Settings> bus_table()
{
    return {
        "",
        {word<bus::Settings, Vendor>({.name = "dds", .sentence = "DDS vendor."}, "DDS vendor", &bus::Settings::vendor, bus::vendor_words()),
         word<bus::Settings, Transport>(
             {.name = "transport", .sentence = "`shm` is Fast DDS's shared memory, `iceoryx` that of Cyclone DDS."}, "transport",
             &bus::Settings::transport, bus::transport_words()),
         word<bus::Settings, bus::SharedMemory>(
             {.name = "shared_memory",
              .sentence = "Where shared memory is asked for and not there: `required` refuses to start, `preferred` goes on by UDP with an "
                          "alarm, `off` does not try."},
             "word", &bus::Settings::shared_memory, bus::shared_memory_words()),
         interface_row(),
         value({.name = "peers", .sentence = "IPv4 addresses for discovery by unicast; empty = multicast."}, &bus::Settings::peers),
         chosen(record<bus::Settings>(bus::bus_record()), {"participants_per_host"})}};
}

}  // namespace

Rows<ProcessSettings> process_rows()
{
    static const Table<ProcessSettings> table{
        "",
        {all_of(&ProcessSettings::bus, bus_table().rows()), security_row(),
         value({.name = "spin", .sentence = "Ask for messages without pause in place of waiting: less latency, a whole processor."},
               &ProcessSettings::spin),
         all_of(&ProcessSettings::node, value({.name = "stamps",
                                               .sentence = "Fill in the time of every hop, for measurements of latency; the sensor's is "
                                                           "always filled in."},
                                              &runtime::NodeSettings::stamps)),
         all_of(&ProcessSettings::realtime, record<runtime::RealtimeSettings>(realtime)),
         all_of(&ProcessSettings::realtime, value({.name = "processors",
                                                   .bounds = settings::Bounds{.lowest = 0, .highest = 1023},
                                                   .sentence = "Processors that it may run on; empty = all."},
                                                  &runtime::RealtimeSettings::processors))}};
    return table.rows();
}

Rows<ProcessSettings> domain_row()
{
    return all_of(&ProcessSettings::bus, chosen(record<bus::Settings>(bus::bus_record()), {"domain"}));
}

}  // namespace quorient::system
