#pragma once

#include "quorient/bus/refusals.hpp"
#include "quorient/bus/security.hpp"
#include "version.hpp"

namespace quorient::bus::fastdds {

/// Makes a participant's properties ask for DDS Security with these files.
void secure(wire::PropertyPolicy& participant, const SecurityFiles& files);

/// The refusals in the library's log, for all participants of this process.
Refusals& library_refusals();

}  // namespace quorient::bus::fastdds
