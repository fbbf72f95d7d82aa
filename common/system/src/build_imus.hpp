#pragma once

#include "build.hpp"
#include "sections/source.hpp"

namespace quorient::system {

/// The axes that the IMUs' mountings are.
void take_mountings(const SourceSection& source, System& system, Report& report);

/// The IMUs of ROS 2 with their axes.
void build_imus(const SourceSection& source, System& system, Report& report);

/// The axes, gains and noise that `source.calibration` states. They take the place of the mountings, where the source has some.
void take_calibration(SourceSection& source, System& system, Report& report);

}  // namespace quorient::system
