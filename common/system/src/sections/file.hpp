#pragma once

#include "lanes.hpp"
#include "monitor.hpp"
#include "source.hpp"
#include "unit.hpp"

#include <fmt/format.h>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace quorient::system {

/// A system file as it stands: every key with the value that holds.
struct File {
    std::string name;
    ProcessSettings process;  ///< for every process that does not say otherwise
    UnitSection unit;
    SourceSection source;
    runtime::OrderSettings commands;
    SensorSection sensor;
    std::vector<LaneSection> lanes;
    voting::VoterSettings voting;
    std::vector<VoterSection> voters;
    std::optional<Ros2OutputSettings> ros2;
    std::optional<MonitorSection> monitor;
    std::vector<std::vector<std::string>> compositions;
    Expectations expect;
};

/// source.rate_hz, by the source's kind where that is left out.
double rate_hz_of(const File& file);
double interval_s_of(const File& file);

/// Calls use(path, settings) for the whole file (whose path is empty), and for each process that has keys of its own.
template <class Use>
void for_each_process(File& file, Use use)
{
    use(std::string{}, file.process);
    use(std::string{"sensor"}, file.sensor.process);
    for (std::size_t i = 0; i < file.lanes.size(); ++i) use(fmt::format("lanes[{}]", i), file.lanes[i].process);
    for (std::size_t i = 0; i < file.voters.size(); ++i) use(fmt::format("voters[{}]", i), file.voters[i].process);
    if (file.monitor) use(std::string{"monitor"}, file.monitor->process);
}

/// The root of a system file. A new section is a table of its own and a row here.
const configuration::Table<File>& file_table();

}  // namespace quorient::system
