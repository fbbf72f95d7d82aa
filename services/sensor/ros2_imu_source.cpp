#include "describe.hpp"
#include "imu_alignment.hpp"
#include "quorient/calibration/cluster_file.hpp"
#include "quorient/messages/name.hpp"
#include "rest_learner.hpp"
#include "sources.hpp"

#include <fmt/format.h>
#include <cassert>
#include <deque>
#include <numbers>

namespace quorient::sensor {

namespace {

/// Discovery takes about a second. A topic that nobody publishes by then is named before five are over.
constexpr std::int64_t publisher_patience_ns = 3'000'000'000;

class Ros2ImuSource final : public FrameSource {
public:
    Ros2ImuSource(const system::SensorSettings& settings, std::uint64_t epoch)
        : settings_(*settings.source.ros2),
          faults_(*settings.cluster, settings.source.scenario.seed),
          description_(describe(*settings.cluster)),
          alignment_(settings_, settings.kind, settings.cluster->interval_s),
          rest_(settings.cluster->instrument, settings_.rest_s),
          reported_(settings_.imus.size(), ImuAlignment::Fault::none),
          topics_(settings_.imus.size(), Topic::awaited),
          domain_(settings.process.bus.domain)
    {
        description_.epoch = epoch;
        description_.revision = 1;
        description_.unit = settings.process.node.unit;
        if (const auto& calibration = settings.source.calibration) {
            correction_ = calibration->correction();
            description_.bias = calibration->description.bias;
        }
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
        attached_ns_ = clock_->steady_ns();
        subscriptions_.resize(settings_.imus.size());
        received_.resize(settings_.imus.size());
        for (std::size_t imu = 0; imu < settings_.imus.size(); ++imu) {
            const auto topic = bus::ros2::imu(settings_.imus[imu].topic.c_str(), bus::ros2::requested);
            subscriptions_[imu] = &loop.on(bus.subscribe(topic), [this, imu](const bus::ros2::Imu& message) {
                received_[imu] = true;
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
        if (rest_.state() == RestLearner::State::learning && !learn(now)) return Advance::not_yet;
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
        if (!learned_.empty()) {
            const Notice notice = std::move(learned_.front());
            learned_.pop_front();
            return notice;
        }
        for (std::size_t imu = 0; imu < topics_.size(); ++imu)
            if (auto notice = topic_notice(imu)) return notice;
        for (std::size_t imu = 0; imu < reported_.size(); ++imu) {
            const auto fault = alignment_.instruments()[imu].fault;
            if (fault == reported_[imu]) continue;
            reported_[imu] = fault;
            const bool well = fault == ImuAlignment::Fault::none;
            return Notice{well ? Severity::info : Severity::warning_high, axes_of(imu),
                          fmt::format("{}: {}", settings_.imus[imu].name, well ? "measures again" : to_string(fault))};
        }
        if (reported_steps_ == alignment_.clock_steps()) return std::nullopt;
        reported_steps_ = alignment_.clock_steps();
        return Notice{Severity::warning_high, all_axes(description_.axis_count), "the IMUs' clock was set: the rotation meanwhile is lost"};
    }

private:
    /// What is known of an IMU's topic before its first message.
    enum class Topic : std::uint8_t {
        awaited,  ///< nothing was said yet
        missed,   ///< its silence was reported
        received,    ///< messages come, or came
    };

    AxisMask axes_of(std::size_t imu) const
    {
        AxisMask axes = 0;
        for (std::size_t axis = 0; axis < description_.axis_count; ++axis) axes |= description_.instrument[axis] == imu ? axis_bit(axis) : 0;
        return axes;
    }

    /// One more raw frame. @returns whether that was the last one that is wanted.
    bool learn(std::int64_t now)
    {
        alignment_.advance(now);
        SensorFrame raw;
        measure(raw);
        rest_.add(raw);
        if (rest_.state() == RestLearner::State::learning) return false;
        if (rest_.state() == RestLearner::State::rested) take_biases();
        else learned_.push_back({Severity::info, 0, "the IMUs move at the start: their biases are not known", EventCode::started});
        alignment_.start(now);  // the calls were a little late, each of them
        return true;
    }

    /// What was learned at rest goes into the next revision of the description.
    void take_biases()
    {
        ++description_.revision;
        for (std::size_t axis = 0; axis < description_.axis_count; ++axis) {
            if (!has_axis(rest_.learned(), axis)) continue;
            description_.bias[axis] = correction_.bias_rad_s[axis] = rest_.bias_rad_s(axis);
            if (description_.sigma[axis] == 0) description_.sigma[axis] = rest_.sigma_rad(axis);
        }
        for (std::size_t imu = 0; imu < settings_.imus.size(); ++imu) learned_.push_back(learned_notice(imu));
    }

    Notice learned_notice(std::size_t imu) const
    {
        const AxisMask axes = axes_of(imu);
        const AxisMask missing = axes & ~rest_.learned();
        const auto& name = settings_.imus[imu].name;
        if (missing == axes) return {Severity::warning_low, axes, fmt::format("{}: its bias at rest is not known", name), EventCode::started};
        std::string text = fmt::format("{}: bias at rest", name);
        for (std::size_t axis = 0; axis < description_.axis_count; ++axis) {
            if (!has_axis(axes, axis)) continue;
            if (has_axis(missing, axis)) text += " unknown";
            else text += fmt::format(" {:+.3f}", rest_.bias_rad_s(axis) * 180 / std::numbers::pi);
        }
        return {missing == 0 ? Severity::info : Severity::warning_low, axes, text + " deg/s, taken out", EventCode::started};
    }

    /// Names a topic from which nothing comes, once, and once more when it comes.
    std::optional<Notice> topic_notice(std::size_t imu)
    {
        auto& topic = topics_[imu];
        if (topic == Topic::received || subscriptions_.empty()) return std::nullopt;
        const auto shown = ros_name(settings_.imus[imu].topic);
        if (received_[imu]) {
            const bool was_missed = topic == Topic::missed;
            topic = Topic::received;
            if (!was_missed) return std::nullopt;
            return Notice{Severity::info, axes_of(imu), fmt::format("{}: {} is published now", settings_.imus[imu].name, shown), EventCode::no_match};
        }
        if (topic == Topic::missed || clock_->steady_ns() - attached_ns_ < publisher_patience_ns) return std::nullopt;
        topic = Topic::missed;
        return Notice{Severity::warning_high, axes_of(imu), why_silent(imu, shown), EventCode::no_match};
    }

    std::string why_silent(std::size_t imu, std::string_view shown)
    {
        const auto& name = settings_.imus[imu].name;
        const auto status = subscriptions_[imu]->status();
        if (status.matched > 0) return fmt::format("{}: {} has a publisher that sends nothing", name, shown);
        if (status.incompatible > 0) return fmt::format("{}: the publisher of {} offers another {}", name, shown, status.policy);
        return fmt::format("{}: nobody publishes sensor_msgs/Imu on {}: wrong name, type, interface or ROS_DOMAIN_ID (here {})?", name,
                           shown, domain_);
    }

    /// "rt/imu/data" as ROS 2 writes it.
    static std::string_view ros_name(std::string_view dds_name)
    {
        return dds_name.substr(dds_name.find('/'));
    }

    void fill(std::uint64_t sequence, SensorFrame& frame)
    {
        const auto length_ns = alignment_.end_ns() - alignment_.begin_ns();
        // After a step of the IMUs' clock the frames' time goes on by intervals, never back.
        time_ns_ = time_ns_ == 0 ? alignment_.end_ns() : time_ns_ + length_ns;
        measure(frame);
        frame.epoch = description_.epoch;
        frame.sequence = sequence;
        frame.sample_time_ns = time_ns_;
        frame.unit = description_.unit;
        frame.kind = description_.kind;
        frame.axis_count = description_.axis_count;
        frame.description_revision = description_.revision;
        for (std::size_t axis = 0; axis < description_.axis_count; ++axis)
            if (has_axis(frame.valid_mask, axis)) frame.increment[axis] = correction_.corrected(axis, frame.increment[axis], frame.interval_s);
        faults_.apply(frame, static_cast<double>(sequence) * description_.interval_s);
        accumulator_.add(frame);
    }

    /// The raw increments of the interval in hand.
    void measure(SensorFrame& frame) const
    {
        frame = {};
        frame.interval_s = static_cast<double>(alignment_.end_ns() - alignment_.begin_ns()) * 1e-9;
        std::array<std::size_t, max_axes> component{};
        for (std::size_t axis = 0; axis < description_.axis_count; ++axis) {
            const auto imu = description_.instrument[axis];
            const auto& instrument = alignment_.instruments()[imu];
            const auto row = static_cast<Eigen::Index>(component[imu]++);
            if (!instrument.valid) continue;
            frame.valid_mask |= axis_bit(axis);
            frame.increment[axis] = instrument.increment(row);
        }
    }

    system::Ros2SourceSettings settings_;
    simulation::FaultInjector faults_;
    simulation::FrameAccumulator accumulator_;
    ClusterDescription description_;
    calibration::Correction correction_ = calibration::Correction::none();
    ImuAlignment alignment_;
    RestLearner rest_;
    std::deque<Notice> learned_;  ///< at the start, not reported yet
    std::vector<ImuAlignment::Fault> reported_;
    std::vector<Topic> topics_;  ///< for each IMU
    std::vector<bool> received_;    ///< for each IMU: whether a message came
    std::vector<bus::Subscription<bus::ros2::Imu>*> subscriptions_;
    std::uint32_t domain_;
    std::int64_t attached_ns_ = 0;
    const runtime::Clock* clock_ = nullptr;
    std::uint64_t reported_steps_ = 0;
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
