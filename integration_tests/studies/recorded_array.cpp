#include "recorded_array.hpp"

#include "quorient/messages/name.hpp"
#include "quorient/calibration/gated_terms.hpp"
#include "quorient/calibration/log_sample.hpp"
#include "quorient/calibration/motion_level.hpp"
#include "quorient/messages/time.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>

namespace quorient::studies {

namespace {

/// Places of the axes of these instruments.
std::vector<std::size_t> axes_of(const ClusterDescription& description, const std::vector<std::size_t>& instruments)
{
    std::vector<std::size_t> axes;
    for (std::size_t axis = 0; axis < description.axis_count; ++axis)
        if (std::find(instruments.begin(), instruments.end(), description.instrument[axis]) != instruments.end()) axes.push_back(axis);
    return axes;
}

/// The description of these axes alone; their instruments numbered anew.
ClusterDescription part_of(const ClusterDescription& whole, const std::vector<std::size_t>& axes,
                           const std::vector<std::size_t>& instruments)
{
    ClusterDescription part;
    part.interval_s = whole.interval_s;
    part.kind = whole.kind;
    part.axis_count = static_cast<std::uint8_t>(axes.size());
    part.instrument_count = static_cast<std::uint8_t>(instruments.size());
    for (std::size_t i = 0; i < instruments.size(); ++i) part.instrument_name[i] = whole.instrument_name[instruments[i]];
    for (std::size_t i = 0; i < axes.size(); ++i) {
        part.axis[i] = whole.axis[axes[i]];
        part.sigma[i] = whole.sigma[axes[i]];
        part.quantum[i] = whole.quantum[axes[i]];
        part.range[i] = whole.range[axes[i]];
        const auto place = std::find(instruments.begin(), instruments.end(), whole.instrument[axes[i]]);
        part.instrument[i] = static_cast<std::uint8_t>(place - instruments.begin());
    }
    return part;
}

SensorFrame frame_of(const calibration::Sample& sample, std::uint64_t sequence, const calibration::CalibratedCluster& calibration,
                     const std::vector<std::size_t>& axes)
{
    SensorFrame frame;
    frame.epoch = 1;
    frame.sequence = sequence;
    frame.sample_time_ns = nanoseconds(sample.time_s);
    frame.interval_s = sample.interval_s;
    frame.axis_count = static_cast<std::uint8_t>(axes.size());
    frame.valid_mask = sample.complete ? all_axes(axes.size()) : 0;
    for (std::size_t i = 0; i < axes.size(); ++i) frame.increment[i] = calibration.corrected(sample, axes[i]);
    return frame;
}

/// The longest stretch between resting segments.
calibration::Segment longest_motion(const std::vector<calibration::Segment>& rest, std::size_t samples)
{
    calibration::Segment longest;
    std::size_t begin = 0;
    const auto consider = [&](std::size_t end) {
        if (end > begin && end - begin > longest.size()) longest = {begin, end};
    };
    for (const auto& segment : rest) {
        consider(segment.begin);
        begin = segment.end;
    }
    consider(samples);
    return longest;
}

}  // namespace

tl::expected<Recording, std::string> load_recording(const std::filesystem::path& log)
{
    auto reader = recording::open_log(log);
    if (!reader) return tl::unexpected(reader.error());
    Recording recording;
    recording.name = log.parent_path().filename().string();
    recording::RecordedFrame frame;
    std::uint64_t sequence = 0;
    for (auto outcome = (*reader)->next(frame); outcome != recording::ReadOutcome::end; outcome = (*reader)->next(frame)) {
        if (outcome == recording::ReadOutcome::rejected) continue;
        sequence += frame.lost_before;
        recording.samples.push_back(calibration::sample_of(frame));
        recording.sequence.push_back(sequence++);
    }
    recording.nominal = (*reader)->description();
    auto calibration = calibration::calibrate(recording.samples, recording.nominal);
    if (!calibration) return tl::unexpected(fmt::format("{}: {}", log.string(), calibration.error()));
    recording.calibration = std::move(*calibration);
    const auto motion = calibration::motion_level(recording.samples, recording.calibration);
    recording.calibration.cluster.motion_level = motion ? motion->level : 0;
    recording.calibration.cluster.gated = calibration::gated_terms(recording.samples, recording.nominal, recording.calibration);
    return recording;
}

tl::expected<RecordedArray, std::string> corrected(const Recording& recording, const calibration::CalibratedCluster& calibration,
                                                   const std::vector<std::size_t>& instruments)
{
    const ClusterDescription& theirs = calibration.description;
    const ClusterDescription& ours = recording.calibration.cluster.description;
    if (theirs.axis_count != ours.axis_count || theirs.instrument != ours.instrument || theirs.instrument_name != ours.instrument_name)
        return tl::unexpected(fmt::format("{}: the other recording is of other sensors", recording.name));
    const auto axes = axes_of(theirs, instruments);
    auto cluster = geometry::make_cluster(part_of(theirs, axes, instruments));
    if (!cluster) return tl::unexpected(fmt::format("{}: {}", recording.name, cluster.error()));

    RecordedArray array;
    array.name = recording.name;
    for (const std::size_t instrument : instruments) array.name += fmt::format(" {}", text_of(theirs.instrument_name[instrument]));
    array.cluster = std::move(*cluster);
    if (calibration.motion_level > 0) array.motion_noise = calibration.motion_level;
    array.gated_noise = calibration.gated;
    array.frames.reserve(recording.samples.size());
    for (std::size_t i = 0; i < recording.samples.size(); ++i)
        array.frames.push_back(frame_of(recording.samples[i], recording.sequence[i], calibration, axes));
    array.rest = recording.calibration.rest;
    array.motion = longest_motion(array.rest, array.frames.size());
    return array;
}

tl::expected<std::vector<Recording>, std::string> load_recordings(const std::vector<std::filesystem::path>& logs)
{
    std::vector<Recording> recordings;
    for (const auto& log : logs) {
        auto recording = load_recording(log);
        if (!recording) return tl::unexpected(recording.error());
        recordings.push_back(std::move(*recording));
    }
    return recordings;
}

tl::expected<std::vector<RecordedArray>, std::string> cross_corrected(const std::vector<Recording>& recordings)
{
    std::vector<RecordedArray> arrays;
    for (std::size_t i = 0; i < recordings.size(); ++i) {
        const std::size_t other = (i + 1) % recordings.size();
        const auto& calibration = recordings[other].calibration.cluster;
        std::vector<std::size_t> all(calibration.description.instrument_count);
        std::iota(all.begin(), all.end(), 0);
        std::vector<std::vector<std::size_t>> sets{all};
        if (all.size() >= 5) sets.insert(sets.begin(), {0, 2, 4});
        for (const auto& set : sets) {
            auto array = corrected(recordings[i], calibration, set);
            if (!array) return tl::unexpected(array.error());
            array->recording = i;
            array->calibrated_by = other;
            arrays.push_back(std::move(*array));
        }
    }
    return arrays;
}

tl::expected<std::vector<RecordedArray>, std::string> load_arrays(const std::vector<std::filesystem::path>& logs)
{
    return load_recordings(logs).and_then(cross_corrected);
}

double RecordedArray::duration_s() const
{
    return static_cast<double>(frames.back().sample_time_ns - frames.front().sample_time_ns) * 1e-9;
}

}  // namespace quorient::studies
