#pragma once

#include "quorient/recording/instrument_log.hpp"
#include "readers.hpp"

namespace quorient::recording {

/// The triads of a log of frames, as instruments of their own.
/// @param frames  of instruments with three axes each
std::unique_ptr<InstrumentLog> frame_instruments(std::unique_ptr<MimuReader> frames, std::string format);

}  // namespace quorient::recording
