#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/truth_state.hpp"
#include "quorient/recording/instrument_log.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/simulation/faults.hpp"
#include "quorient/system/system.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

namespace quorient::sensor {

enum class Advance { frame, nothing, not_yet, end };

/// What a source met and an operator should know.
struct Notice {
    Severity severity = Severity::info;
    AxisMask axes = 0;
    std::string text;
    EventCode code = EventCode::rejected_input;
};

/// Where frames come from: a simulated instrument, a log, other nodes. Sequences may jump forward, never back.
class FrameSource {
public:
    virtual ~FrameSource() = default;

    /// Where the source listens to other nodes: called once, before anything else.
    virtual void attach(bus::Bus&, runtime::EventLoop&) {}

    /// Complete, with epoch and revision.
    virtual const ClusterDescription& description() const = 0;

    /// The frame of this sequence with faults applied, and the truth at its end. `nothing`: this sequence was lost in the log;
    /// `not_yet`: the first frame cannot begin, ask again.
    virtual Advance advance_to(std::uint64_t sequence, SensorFrame& frame, TruthState& truth) = 0;

    virtual simulation::FaultInjector& faults() = 0;

    /// What is new to report; asked until there is nothing.
    virtual std::optional<Notice> notice() { return std::nullopt; }

    /// What was met so far that an operator should know (refused records of a log); empty if nothing.
    virtual std::string remarks() const { return {}; }
};

/// @param log  what a table does not say itself
/// @returns an error for a log that cannot be read, moves while it should rest.
tl::expected<std::unique_ptr<FrameSource>, std::string> make_source(const system::SensorSettings& settings, std::uint64_t epoch,
                                                                    const recording::LogOptions& log = {});

}  // namespace quorient::sensor
