#pragma once

#include "quorient/configuration/table.hpp"
#include "quorient/system/system.hpp"

namespace quorient::system {

/// `security`: of the whole file, and of each lane, each voter, the sensor and the monitor.
configuration::Rows<ProcessSettings> security_row();

/// `commands`: the orders that a unit obeys.
const configuration::Table<runtime::OrderSettings>& commands_table();

}  // namespace quorient::system
