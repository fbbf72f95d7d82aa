#include "field_log.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/recording/aligned_logs.hpp"
#include "quorient/recording/reader.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace quorient::studies {
namespace {

constexpr std::size_t triad = 3;
constexpr std::size_t few = 3;   ///< instruments of the smaller sets of a large array
constexpr std::size_t many = 6;  ///< from so many on not every set is tried

SensorFrame frame_of(const recording::RecordedFrame& recorded, std::uint64_t sequence)
{
    SensorFrame frame;
    frame.epoch = 1;
    frame.sequence = sequence;
    frame.sample_time_ns = recorded.time_ns;
    frame.interval_s = recorded.interval_s;
    frame.kind = octet(SensorKind::gyro);
    frame.axis_count = static_cast<std::uint8_t>(recorded.axis_count);
    frame.valid_mask = recorded.valid_mask;
    std::copy_n(recorded.increment.begin(), recorded.axis_count, frame.increment.begin());
    return frame;
}

double usual_interval_s(const std::vector<SensorFrame>& frames)
{
    std::vector<double> intervals;
    for (const SensorFrame& frame : frames) intervals.push_back(frame.interval_s);
    const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
    std::nth_element(intervals.begin(), middle, intervals.end());
    return *middle;
}

geometry::SensorCluster parallel_triads(std::size_t axes)
{
    geometry::SensorCluster cluster;
    cluster.axes = geometry::Axes::Zero(static_cast<Eigen::Index>(axes), 3);
    for (std::size_t axis = 0; axis < axes; ++axis) {
        cluster.axes(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(axis % triad)) = 1;
        cluster.instrument.push_back(axis / triad);
        if (axis % triad == 0) cluster.instrument_name.push_back(fmt::format("g{}", axis / triad));
    }
    const auto size = static_cast<Eigen::Index>(axes);
    cluster.sigma.setZero(size);
    cluster.quantum.setZero(size);
    cluster.range.setZero(size);
    return cluster;
}

tl::expected<geometry::SensorCluster, std::string> cluster_of(const ClusterDescription& description)
{
    bool points = false;
    for (std::size_t axis = 0; axis < description.axis_count; ++axis)
        for (const double component : description.axis[axis]) points = points || component != 0;
    if (points) return geometry::make_cluster(description);
    if (description.axis_count % triad != 0)
        return tl::unexpected(fmt::format("{} axes are no triads, and the log does not say where they point", description.axis_count));
    return parallel_triads(description.axis_count);
}

}  // namespace

double FieldLog::duration_s() const
{
    return static_cast<double>(frames.back().sample_time_ns - frames.front().sample_time_ns) * 1e-9;
}

namespace {

tl::expected<FieldLog, std::string> load_file(const std::filesystem::path& file)
{
    auto reader = recording::open_log(file);
    if (!reader) return tl::unexpected(reader.error());
    FieldLog log;
    recording::RecordedFrame recorded;
    std::uint64_t sequence = 0;
    for (auto outcome = (*reader)->next(recorded); outcome != recording::ReadOutcome::end; outcome = (*reader)->next(recorded)) {
        if (outcome == recording::ReadOutcome::rejected) continue;
        sequence += recorded.lost_before;
        log.frames.push_back(frame_of(recorded, sequence++));
    }
    if (log.frames.empty()) return tl::unexpected(std::string("no frame can be read"));
    auto cluster = cluster_of((*reader)->description());
    if (!cluster) return tl::unexpected(cluster.error());
    log.cluster = std::move(*cluster);
    return log;
}

SensorFrame frame_of(const recording::AlignedFrame& aligned, std::uint64_t sequence)
{
    recording::RecordedFrame recorded;
    recorded.time_ns = aligned.time_ns;
    recorded.interval_s = aligned.interval_s;
    recorded.axis_count = 3 * aligned.count;
    recorded.valid_mask = aligned.valid_mask;
    for (std::size_t axis = 0; axis < recorded.axis_count; ++axis)
        recorded.increment[axis] = aligned.rate_rad_s[axis / triad][axis % triad] * aligned.interval_s;
    return frame_of(recorded, sequence);
}

std::vector<std::filesystem::path> csv_files(const std::filesystem::path& folder)
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".csv") files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

/// Several logs of one motion on common intervals.
tl::expected<FieldLog, std::string> load_folder(const std::filesystem::path& folder)
{
    const auto files = csv_files(folder);
    auto survey = recording::survey(files, {});
    if (!survey) return tl::unexpected(survey.error());
    if (const auto tied = recording::tie_clocks(*survey); !tied) return tl::unexpected(tied.error());
    auto logs = recording::AlignedLogs::open(*survey);
    if (!logs) return tl::unexpected(logs.error());
    FieldLog log;
    recording::AlignedFrame aligned;
    std::uint64_t sequence = 0;
    std::int64_t before_ns = 0;
    for (auto outcome = logs->next(aligned); outcome != recording::ReadOutcome::end; outcome = logs->next(aligned)) {
        if (outcome == recording::ReadOutcome::rejected) continue;
        const double passed_s = static_cast<double>(aligned.time_ns - before_ns) * 1e-9;
        if (!log.frames.empty()) sequence += static_cast<std::uint64_t>(std::max(1L, std::lround(passed_s / logs->interval_s())));
        before_ns = aligned.time_ns;
        log.frames.push_back(frame_of(aligned, sequence));
    }
    if (log.frames.empty()) return tl::unexpected(std::string("no frame can be read"));
    log.cluster = parallel_triads(survey->compared.size() * triad);
    for (std::size_t m = 0; m < survey->compared.size(); ++m)
        log.cluster.instrument_name[m] = std::filesystem::path(survey->logs[survey->instruments[survey->compared[m]].log].name).stem().string();
    return log;
}

}  // namespace

tl::expected<FieldLog, std::string> load_field_log(const std::filesystem::path& file)
{
    auto log = std::filesystem::is_directory(file) ? load_folder(file) : load_file(file);
    if (!log) return tl::unexpected(fmt::format("{}: {}", file.string(), log.error()));
    const bool generic = file.stem() == "data";
    log->name = generic ? file.parent_path().filename().string() : file.stem().string();
    log->cluster.interval_s = usual_interval_s(log->frames);
    return log;
}

FieldLog part_of(const FieldLog& log, const std::vector<std::size_t>& instruments)
{
    std::vector<std::size_t> axes;
    for (const std::size_t m : instruments)
        for (std::size_t axis = 0; axis < log.cluster.size(); ++axis)
            if (log.cluster.instrument[axis] == m) axes.push_back(axis);

    FieldLog part{.name = log.name, .cluster = parallel_triads(axes.size()), .frames = log.frames};
    part.cluster.interval_s = log.cluster.interval_s;
    for (std::size_t i = 0; i < instruments.size(); ++i) part.cluster.instrument_name[i] = log.cluster.instrument_name[instruments[i]];
    if (instruments.size() < log.instruments()) {
        part.name += " (";
        for (const auto& name : part.cluster.instrument_name) part.name += (part.name.back() == '(' ? "" : " ") + name;
        part.name += ")";
    }
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const auto from = static_cast<Eigen::Index>(axes[i]);
        const auto to = static_cast<Eigen::Index>(i);
        part.cluster.axes.row(to) = log.cluster.axes.row(from);
        part.cluster.quantum(to) = log.cluster.quantum(from);
        part.cluster.range(to) = log.cluster.range(from);
    }
    for (std::size_t k = 0; k < part.frames.size(); ++k) {
        SensorFrame& frame = part.frames[k];
        frame.axis_count = static_cast<std::uint8_t>(axes.size());
        frame.valid_mask = 0;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            frame.increment[i] = log.frames[k].increment[axes[i]];
            if (has_axis(log.frames[k].valid_mask, axes[i])) frame.valid_mask |= axis_bit(i);
        }
    }
    return part;
}

std::vector<std::vector<std::size_t>> instrument_sets(std::size_t instruments)
{
    std::vector<std::size_t> all(instruments);
    std::iota(all.begin(), all.end(), 0);
    std::vector<std::vector<std::size_t>> sets{all};
    if (instruments >= many) sets.push_back({0, 2, 4});
    if (instruments >= many || instruments <= few) return sets;
    for (std::uint32_t members = 0; members < (1U << instruments); ++members) {
        std::vector<std::size_t> set;
        for (const std::size_t m : all)
            if ((members >> m & 1U) != 0) set.push_back(m);
        if (set.size() >= few && set.size() < instruments) sets.push_back(std::move(set));
    }
    return sets;
}

}  // namespace quorient::studies
