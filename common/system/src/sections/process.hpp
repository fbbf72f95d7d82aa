#pragma once

#include "quorient/configuration/table.hpp"
#include "quorient/system/system.hpp"

namespace quorient::system {

/// How a process joins the bus and how it is scheduled: keys of the whole file, and of each lane, each voter and the sensor.
configuration::Rows<ProcessSettings> process_rows();

/// The DDS domain, which all processes share.
configuration::Rows<ProcessSettings> domain_row();

}  // namespace quorient::system
