#pragma once

#include "quorient/bus/refusals.hpp"
#include "quorient/bus/security.hpp"

#include <dds/dds.h>

namespace quorient::bus::cyclonedds {

/// Makes a participant's QoS ask for DDS Security with these files.
void secure(dds_qos_t& participant, const SecurityFiles& files);

/// The refusals in the library's log, for all participants of this process.
Refusals& library_refusals();

}  // namespace quorient::bus::cyclonedds
