#pragma once

#include <string>

namespace rogue {

/// True: the vendor's check of this process's own permissions always passes.
extern bool patched;

/// Added to the result of time() in this process. With the clock set back an expired certificate still passes the process's own check.
extern long clock_offset_s;

/// Path of the access-control plug-in for Cyclone DDS beside this program.
std::string patched_plugin();

}  // namespace rogue
