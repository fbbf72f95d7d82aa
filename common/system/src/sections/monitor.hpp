#pragma once

#include "quorient/configuration/table.hpp"
#include "quorient/system/system.hpp"

#include <string>

namespace quorient::system {

/// `monitor`: the process that shows the system on a page.
struct MonitorSection {
    std::string name = "monitor";
    ProcessSettings process;
    std::string address = "127.0.0.1";
    std::uint32_t port = 8080;
    bool allow_orders = false;
    std::string token_file;
};

const configuration::Table<MonitorSection>& monitor_table();

/// What it has before its keys are read: it joins as the others do, but never before the pipeline, and not in its shared memory.
void prepare_monitor(const ProcessSettings& file, MonitorSection& monitor);

}  // namespace quorient::system
