#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/recording/reader.hpp"
#include "quorient/system/system.hpp"
#include "report/sample_store.hpp"

namespace quorient::cli {

/// What the gyros of a running unit measured, as it was before its publisher took biases and gains out.
struct LiveSamples {
    SampleStore samples;
    ClusterDescription nominal;  ///< axes as published; range and quantum of the raw measurements
    recording::Statistics statistics;
};

/// Receives a unit's frames for so long, or until the user ends it.
/// @throws Exit{1} where none comes, Exit{2} where the bus or the room for the samples cannot be had, after explaining it on stderr.
LiveSamples receive_samples(const system::System& system, double duration_s);

}  // namespace quorient::cli
