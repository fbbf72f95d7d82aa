#include "describe.hpp"
#include "quorient/attitude/levelling.hpp"
#include "quorient/calibration/cluster_file.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/recording/merge.hpp"
#include "quorient/recording/rest_statistics.hpp"
#include "quorient/rotation/quaternion.hpp"
#include "sources.hpp"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

namespace quorient::sensor {

namespace {

/// A log's axes as they go on the wire, and how its increments become theirs.
struct DescribedLog {
    ClusterDescription description;
    calibration::Correction correction = calibration::Correction::none();
    std::string remark{};
};

/// The log's name, or that of the first of several: its problems are reported by it.
const std::string& name_of(const system::SensorSettings& settings)
{
    return settings.source.log->files.front();
}

tl::expected<recording::MergedLogs, std::string> open(const system::SensorSettings& settings, const recording::LogOptions& options)
{
    const std::vector<std::filesystem::path> files(settings.source.log->files.begin(), settings.source.log->files.end());
    return recording::open_logs(files, options);
}

/// The file's rate against the log's own time stamps.
std::optional<std::string> doubted_rate(double logged_hz, std::optional<double> stated)
{
    constexpr double tolerance = 0.1;
    if (!stated || std::abs(*stated / logged_hz - 1) <= tolerance) return std::nullopt;
    return fmt::format("source.rate_hz is {:.4g}, and the log has {:.4g} frames a second by its own time stamps", *stated, logged_hz);
}

class LogSource final : public FrameSource {
public:
    LogSource(recording::MergedLogs logs, const geometry::SensorCluster& cluster, const DescribedLog& described,
              const system::SensorSettings& settings)
        : reader_(std::move(logs.reader)),
          description_(described.description),
          faults_(cluster, settings.source.scenario.seed),
          correction_(described.correction),
          from_s_(settings.source.log->from_s),
          to_s_(settings.source.log->to_s.value_or(std::numeric_limits<double>::infinity()))
    {
        if (auto doubt = doubted_rate(1 / reader_->description().interval_s, settings.source.log->stated_rate_hz))
            remarks_.push_back(std::move(*doubt));
        if (!described.remark.empty()) remarks_.push_back(described.remark);
        remarks_.insert(remarks_.end(), logs.remarks.begin(), logs.remarks.end());
    }

    const ClusterDescription& description() const override { return description_; }
    simulation::FaultInjector& faults() override { return faults_; }
    std::string remarks() const override
    {
        std::string text = recording::summary(reader_->statistics());
        for (const std::string& remark : remarks_) text += "; " + remark;
        return text;
    }

    Advance advance_to(std::uint64_t sequence, SensorFrame& frame, TruthState& truth) override
    {
        while (next_sequence_ <= sequence) {
            if (!read()) return Advance::end;
        }
        if (next_sequence_ != sequence + 1) return Advance::nothing;
        frame = frame_;
        truth = truth_;
        return Advance::frame;
    }

private:
    /// Makes frame_ of the next record between from_s and to_s; false at the end.
    bool read()
    {
        for (;;) {
            const auto outcome = reader_->next(record_);
            if (outcome == recording::ReadOutcome::end) return false;
            if (outcome == recording::ReadOutcome::rejected) continue;
            const double time_s = static_cast<double>(record_.time_ns) * 1e-9;
            if (time_s >= to_s_) return false;
            if (time_s >= from_s_) break;
            started_ = false;
        }
        if (started_ && record_.lost_before > 0) {
            accumulator_.skip(static_cast<std::uint32_t>(record_.lost_before));
            next_sequence_ += record_.lost_before;
        }
        started_ = true;
        convert();
        ++next_sequence_;
        return true;
    }

    void convert()
    {
        frame_.epoch = truth_.epoch = description_.epoch;
        frame_.sequence = truth_.sequence = next_sequence_;
        frame_.sample_time_ns = truth_.sample_time_ns = record_.time_ns;
        frame_.interval_s = record_.interval_s;
        frame_.unit = truth_.unit = description_.unit;
        frame_.kind = description_.kind;
        frame_.axis_count = description_.axis_count;
        frame_.description_revision = description_.revision;
        frame_.valid_mask = record_.valid_mask;
        for (std::size_t axis = 0; axis < description_.axis_count; ++axis)
            frame_.increment[axis] = correction_.corrected(axis, record_.increment[axis], record_.interval_s);
        truth_.attitude_known = record_.truth.has_value();
        if (record_.truth) truth_.attitude = *record_.truth;
        const double begin_s = static_cast<double>(record_.time_ns) * 1e-9 - record_.interval_s;
        truth_.faulty_mask = faults_.apply(frame_, begin_s);
        accumulator_.add(frame_);
    }

    std::unique_ptr<recording::Reader> reader_;
    std::vector<std::string> remarks_;  ///< on how the log was understood
    ClusterDescription description_;
    simulation::FaultInjector faults_;
    simulation::FrameAccumulator accumulator_;
    calibration::Correction correction_;
    double from_s_;
    double to_s_;
    recording::RecordedFrame record_;
    SensorFrame frame_;
    TruthState truth_;
    std::uint64_t next_sequence_ = 0;
    bool started_ = false;
};

/// What shows that two descriptions are not of the same sensors; nothing if axes and instruments agree.
std::optional<std::string> difference(const ClusterDescription& calibrated, const ClusterDescription& log)
{
    if (calibrated.axis_count != log.axis_count) return fmt::format("{} axes, the log has {}", calibrated.axis_count, log.axis_count);
    for (std::size_t axis = 0; axis < log.axis_count; ++axis) {
        const auto theirs = text_of(calibrated.instrument_name[calibrated.instrument[axis]]);
        const auto ours = text_of(log.instrument_name[log.instrument[axis]]);
        if (!ours.empty() && theirs != ours) return fmt::format("axis {} is of instrument {}, in the log of {}", axis, theirs, ours);
    }
    return std::nullopt;
}

void state_attitude(ClusterDescription& description, const std::array<double, 4>& attitude, InitialAttitude known)
{
    description.initial_attitude = attitude;
    description.initial_attitude_known = octet(known);
}

/// Roll and pitch from the mean specific force of all accelerometers, which stand as the gyros do.
tl::expected<attitude::Quaternion, std::string> level_at_rest(const system::SensorSettings& settings, const recording::RestStatistics& rest,
                                                              const ClusterDescription& description)
{
    if (settings.source.log->from_s > settings.source.log->rest_s)
        return tl::make_unexpected(
            fmt::format("levelled at rest, in the first {} s, but played from {} s: begin at rest or state initial_attitude",
                        settings.source.log->rest_s, settings.source.log->from_s));
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t axis = 0; axis < description.axis_count; ++axis) {
        if (!has_axis(rest.acceleration_mask, axis)) continue;
        const Eigen::Map<const Eigen::Vector3d> direction(description.axis[axis].data());
        information += direction * direction.transpose();
        sum += rest.acceleration_m_s2[axis] * direction;
    }
    const Eigen::FullPivLU<Eigen::Matrix3d> solver(information);
    if (!solver.isInvertible()) return tl::make_unexpected("cannot level: the log has no three accelerometer axes");
    return attitude::level(solver.solve(sum), *settings.levelled_heading_rad);
}

/// The log's own geometry with the biases and sigmas of its beginning, or the system file's with its noise.
tl::expected<DescribedLog, std::string> describe_log(recording::Reader& reader, const system::SensorSettings& settings, std::uint64_t epoch)
{
    DescribedLog described{.description = reader.description()};
    auto& description = described.description;
    const ClusterDescription recorded = description;
    if (settings.source.log->of_imus) {
        if (const auto other = difference(describe(*settings.cluster), recorded))
            return tl::make_unexpected(fmt::format("{}: the system file's IMUs are other sensors: {}", name_of(settings), *other));
    }
    if (settings.cluster) {
        if (settings.cluster->size() != description.axis_count)
            return tl::make_unexpected(fmt::format("{}: has {} axes, the system file's layout {}", name_of(settings),
                                                   description.axis_count, settings.cluster->size()));
        description = describe(*settings.cluster);
    }
    const auto& calibration = settings.source.calibration;
    if (calibration) {
        if (const auto other = difference(calibration->description, description))
            return tl::make_unexpected(fmt::format("{}: the calibration is of other sensors: {}", name_of(settings), *other));
        description = calibration->description;
        if (calibration::is_corrected(recorded, description))
            described.remark = "the recording holds increments that this calibration corrected: they are taken as they are";
        else described.correction = calibration->correction();
    }
    std::optional<attitude::Quaternion> levelled;
    if (settings.source.log->rest_s > 0) {
        const auto rest = recording::rest_statistics(reader, settings.source.log->rest_s);
        if (!rest) return tl::make_unexpected(rest.error());
        description.bias = described.correction.bias_rad_s = rest->bias_rad_s;
        if (!calibration) description.sigma = rest->sigma_rad;
        if (settings.levelled_heading_rad) {
            const auto attitude = level_at_rest(settings, *rest, description);
            if (!attitude) return tl::make_unexpected(fmt::format("{}: {}", name_of(settings), attitude.error()));
            levelled = *attitude;
        }
    }
    for (std::size_t axis = 0; settings.range > 0 && axis < description.axis_count; ++axis) description.range[axis] = settings.range;
    description.epoch = epoch;
    description.revision = 1;
    description.unit = settings.process.node.unit;
    if (levelled) state_attitude(description, attitude::to_array(*levelled), InitialAttitude::measured);
    if (settings.initial_attitude) state_attitude(description, *settings.initial_attitude, InitialAttitude::stated);
    copy_text(settings.unit_name, description.name);
    return described;
}

/// Where a log with truth begins: its first truth is that at the *end* of the first interval, so the first rotation is taken back.
/// Exact but for the coning within one interval and the first frame's quantisation.
std::optional<std::array<double, 4>> attitude_at_start(recording::Reader& reader, const geometry::SensorCluster& cluster)
{
    recording::RecordedFrame first;
    if (reader.next(first) != recording::ReadOutcome::frame || !first.truth) return std::nullopt;
    const geometry::AxisVector increment = Eigen::Map<const Eigen::VectorXd>(first.increment.data(), cluster.axes.rows());
    const Eigen::Vector3d rotation = (cluster.axes.transpose() * cluster.axes).ldlt().solve(cluster.axes.transpose() * increment);
    return attitude::to_array(attitude::from_array(*first.truth) * attitude::from_rotation_vector(-rotation));
}

}  // namespace

tl::expected<std::unique_ptr<FrameSource>, std::string> make_log_source(const system::SensorSettings& settings, std::uint64_t epoch,
                                                                        const recording::LogOptions& options)
{
    auto beginning = open(settings, options);
    if (!beginning) return tl::make_unexpected(beginning.error());
    auto described = describe_log(*beginning->reader, settings, epoch);
    if (!described) return tl::make_unexpected(described.error());
    auto& description = described->description;
    const auto cluster = geometry::make_cluster(description);
    if (!cluster) return tl::make_unexpected(fmt::format("{}: {}", name_of(settings), cluster.error()));
    auto again = open(settings, options);
    if (!again) return tl::make_unexpected(again.error());
    if (const auto start = attitude_at_start(*again->reader, *cluster); start && description.initial_attitude_known == 0) {
        state_attitude(description, *start, InitialAttitude::measured);
    }

    auto logs = open(settings, options);
    if (!logs) return tl::make_unexpected(logs.error());
    auto source = std::make_unique<LogSource>(std::move(*logs), *cluster, *described, settings);
    for (const auto& fault : settings.source.scenario.faults) {
        if (const auto added = source->faults().add(fault); !added) return tl::make_unexpected(added.error());
    }
    return source;
}

tl::expected<std::unique_ptr<FrameSource>, std::string> make_source(const system::SensorSettings& settings, std::uint64_t epoch,
                                                                    const recording::LogOptions& log)
{
    if (settings.source.log) return make_log_source(settings, epoch, log);
    if (settings.source.ros2) return make_ros2_source(settings, epoch);
    if (settings.source.vessel) return make_vessel_source(settings, epoch);
    return make_simulation_source(settings, epoch);
}

}  // namespace quorient::sensor
