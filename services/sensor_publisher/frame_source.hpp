#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/truth_state.hpp"
#include "quorient/simulation/faults.hpp"
#include "quorient/system/system.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::sensor {

enum class Advance { frame, nothing, end };

/// Where frames come from: a simulated instrument or a log. Sequences may jump forward, never back.
class FrameSource {
public:
    virtual ~FrameSource() = default;

    /// Complete, with epoch and revision.
    virtual const ClusterDescription& description() const = 0;

    /// The frame of this sequence with faults applied, and the truth at its end. `nothing`: this sequence was lost in the log.
    virtual Advance advance_to(std::uint64_t sequence, SensorFrame& frame, TruthState& truth) = 0;

    virtual simulation::FaultInjector& faults() = 0;

    /// What was met so far that an operator should know (refused records of a log); empty if nothing.
    virtual std::string remarks() const { return {}; }
};

/// @returns an error for a log that cannot be read, moves while it should rest.
tl::expected<std::unique_ptr<FrameSource>, std::string> make_source(const system::SensorSettings& settings, std::uint64_t epoch);

}  // namespace quorient::sensor
