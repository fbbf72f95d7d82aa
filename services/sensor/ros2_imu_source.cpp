#include "describe.hpp"
#include "imu_alignment.hpp"
#include "quorient/messages/name.hpp"
#include "sources.hpp"

#include <fmt/format.h>
#include <cassert>

namespace quorient::sensor {

namespace {

class Ros2ImuSource final : public FrameSource {
public:
    Ros2ImuSource(const system::SensorSettings& settings, std::uint64_t epoch)
        : settings_(*settings.source.ros2),
          faults_(*settings.cluster, settings.source.scenario.seed),
          description_(describe(*settings.cluster)),
          alignment_(settings_, settings.kind, settings.cluster->interval_s),
          told_(settings_.imus.size(), ImuAlignment::Fault::none)
    {
        description_.epoch = epoch;
        description_.revision = 1;
        description_.unit = settings.process.node.unit;
        description_.initial_attitude_known =
            static_cast<std::uint8_t>(settings.initial_attitude ? InitialAttitude::stated : InitialAttitude::unknown);
        if (settings.initial_attitude) description_.initial_attitude = *settings.initial_attitude;
        copy_text(settings.unit_name, description_.name);
        for (const auto& fault : settings.source.scenario.faults) {
            [[maybe_unused]] const auto added = faults_.add(fault);
            assert(added);  // the loader has resolved it on this cluster
        }
        if (settings.kind == SensorKind::accelerometer) return;  // moved to the body's origin already
        for (std::size_t axis = 0; axis < description_.axis_count; ++axis) {
            const auto& place = settings_.imus[description_.instrument[axis]].position_m;
            description_.position_m[axis] = {place.x(), place.y(), place.z()};
        }
    }

    void attach(bus::Bus& bus, runtime::EventLoop& loop) override
    {
        clock_ = &loop.clock();
        subscriptions_.resize(settings_.imus.size());
        for (std::size_t imu = 0; imu < settings_.imus.size(); ++imu) {
            const auto topic = bus::ros2::imu(settings_.imus[imu].topic.c_str(), bus::ros2::requested);
            subscriptions_[imu] = &loop.on(bus.subscribe(topic), [this, imu](const bus::ros2::Imu& message) {
                alignment_.add(imu, message, clock_->steady_ns(), subscriptions_[imu]->status().matched);
            });
        }
    }

    const ClusterDescription& description() const override { return description_; }
    simulation::FaultInjector& faults() override { return faults_; }

    Advance advance_to(std::uint64_t sequence, SensorFrame& frame, TruthState& truth) override
    {
        const auto now = clock_->steady_ns();
        if (!started_ && !alignment_.ready(now)) return Advance::not_yet;
        if (!started_) alignment_.start(now);
        started_ = true;
        for (; next_ <= sequence; ++next_) {
            alignment_.advance(now);
            fill(next_, frame);
        }
        truth.epoch = frame.epoch;
        truth.sequence = frame.sequence;
        truth.sample_time_ns = frame.sample_time_ns;
        truth.unit = frame.unit;
        return Advance::frame;
    }

    std::optional<Notice> notice() override
    {
        for (std::size_t imu = 0; imu < told_.size(); ++imu) {
            const auto fault = alignment_.instruments()[imu].fault;
            if (fault == told_[imu]) continue;
            told_[imu] = fault;
            AxisMask axes = 0;
            for (std::size_t axis = 0; axis < description_.axis_count; ++axis)
                axes |= description_.instrument[axis] == imu ? axis_bit(axis) : 0;
            const bool well = fault == ImuAlignment::Fault::none;
            return Notice{well ? Severity::info : Severity::warning_high, axes,
                          fmt::format("{}: {}", settings_.imus[imu].name, well ? "measures again" : to_string(fault))};
        }
        if (told_steps_ == alignment_.clock_steps()) return std::nullopt;
        told_steps_ = alignment_.clock_steps();
        return Notice{Severity::warning_high, all_axes(description_.axis_count), "the IMUs' clock was set: the rotation meanwhile is lost"};
    }

private:
    void fill(std::uint64_t sequence, SensorFrame& frame)
    {
        const auto length_ns = alignment_.end_ns() - alignment_.begin_ns();
        // After a step of the IMUs' clock the frames' time goes on by intervals, never back.
        time_ns_ = time_ns_ == 0 ? alignment_.end_ns() : time_ns_ + length_ns;
        frame = {};
        frame.epoch = description_.epoch;
        frame.sequence = sequence;
        frame.sample_time_ns = time_ns_;
        frame.interval_s = static_cast<double>(length_ns) * 1e-9;
        frame.unit = description_.unit;
        frame.kind = description_.kind;
        frame.axis_count = description_.axis_count;
        frame.description_revision = description_.revision;
        std::array<std::size_t, max_axes> component{};
        for (std::size_t axis = 0; axis < description_.axis_count; ++axis) {
            const auto imu = description_.instrument[axis];
            const auto& instrument = alignment_.instruments()[imu];
            const auto row = static_cast<Eigen::Index>(component[imu]++);
            if (!instrument.valid) continue;
            frame.valid_mask |= axis_bit(axis);
            frame.increment[axis] = instrument.increment(row);
        }
        faults_.apply(frame, static_cast<double>(sequence) * description_.interval_s);
        accumulator_.add(frame);
    }

    system::Ros2SourceSettings settings_;
    simulation::FaultInjector faults_;
    simulation::FrameAccumulator accumulator_;
    ClusterDescription description_;
    ImuAlignment alignment_;
    std::vector<ImuAlignment::Fault> told_;
    std::vector<bus::Subscription<bus::ros2::Imu>*> subscriptions_;
    const runtime::Clock* clock_ = nullptr;
    std::uint64_t told_steps_ = 0;
    std::uint64_t next_ = 0;
    std::int64_t time_ns_ = 0;
    bool started_ = false;
};

}  // namespace

std::unique_ptr<FrameSource> make_ros2_source(const system::SensorSettings& settings, std::uint64_t epoch)
{
    return std::make_unique<Ros2ImuSource>(settings, epoch);
}

}  // namespace quorient::sensor
