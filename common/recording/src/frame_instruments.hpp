#pragma once

#include "quorient/recording/instrument_log.hpp"
#include "mcap/frame_reader.hpp"
#include "readers.hpp"

namespace quorient::recording {

/// The triads of a log of frames, as instruments of their own.
/// @param frames  of instruments with three axes each
std::unique_ptr<InstrumentLog> frame_instruments(std::unique_ptr<MimuReader> frames, std::string format);

/// The same of a record. @returns an error where its instruments do not have three axes each
tl::expected<std::unique_ptr<InstrumentLog>, std::string> frame_instruments(std::unique_ptr<mcap::FrameReader> frames, const std::string& name);

}  // namespace quorient::recording
