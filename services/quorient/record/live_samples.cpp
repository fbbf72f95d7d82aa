#include "live_samples.hpp"

#include "cli/program.hpp"
#include "cli/progress.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/calibration/cluster_file.hpp"
#include "quorient/intake/frame_intake.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/signals.hpp"

#include <fmt/format.h>
#include <cmath>
#include <csignal>
#include <optional>

namespace quorient::cli {
namespace {

constexpr std::int64_t shown_every_ns = 100'000'000;

/// One unit's frames, in order, as raw samples.
class Receiver {
public:
    explicit Receiver(const system::System& system) : calibration_(system.sensor.source.calibration), intake_(system.unit, SensorKind::gyro) {}

    void on_description(const ClusterDescription& description) { intake_.describe(description); }

    /// @returns false where there is no room for more.
    bool on_frame(const SensorFrame& frame, std::int64_t now_ns)
    {
        intake_.offer(frame, now_ns);
        while (const auto* accepted = intake_.next())
            if (!take(*accepted)) return false;
        return true;
    }

    std::size_t frames() const { return store_ ? store_->size() : 0; }
    bool other_axes() const { return other_axes_; }

    LiveSamples result()
    {
        statistics_.lost = intake_.counters().gaps;
        return {std::move(*store_), nominal_, statistics_};
    }

private:
    bool take(const intake::FrameIntake::Accepted& accepted)
    {
        if (accepted.new_description && !describe(*intake_.description())) return true;
        const SensorFrame& frame = accepted.frame;
        calibration::Sample sample;
        // Epochs are joined: what was between them is not known.
        time_s_ += frame.interval_s;
        sample.time_s = time_s_;
        sample.interval_s = frame.interval_s;
        sample.rate.resize(frame.axis_count);
        for (std::size_t axis = 0; axis < frame.axis_count; ++axis)
            sample.rate(static_cast<Eigen::Index>(axis)) = correction_.raw(axis, frame.increment[axis], frame.interval_s) / frame.interval_s;
        sample.complete = frame.valid_mask == all_axes(frame.axis_count);
        sample.follows = !accepted.new_epoch && accepted.missing_before == 0;
        ++statistics_.records;
        ++statistics_.frames;
        if (!sample.complete) ++statistics_.incomplete;
        statistics_.duration_ns = nanoseconds(time_s_);
        return store_->add(sample);
    }

    /// What its publisher took out of the increments. @returns false where the axes are not those of the frames before.
    bool describe(const ClusterDescription& description)
    {
        other_axes_ = store_ && (description.axis_count != nominal_.axis_count || description.axis != nominal_.axis);
        if (other_axes_) return false;
        correction_ = calibration::Correction::none();
        if (calibration_ && calibration::is_corrected(description, calibration_->description)) correction_.gain = calibration_->gain;
        correction_.bias_rad_s = description.bias;
        if (store_) return true;
        store_.emplace(description.axis_count);
        nominal_ = description;
        for (std::size_t axis = 0; axis < description.axis_count; ++axis) {
            nominal_.quantum[axis] *= correction_.gain[axis];
            if (nominal_.range[axis] > 0)
                nominal_.range[axis] = nominal_.range[axis] * correction_.gain[axis] - std::abs(correction_.bias_rad_s[axis]);
        }
        return true;
    }

    std::optional<calibration::CalibratedCluster> calibration_;
    intake::FrameIntake intake_;
    calibration::Correction correction_ = calibration::Correction::none();
    std::optional<SampleStore> store_;
    ClusterDescription nominal_;
    recording::Statistics statistics_;
    double time_s_ = 0;
    bool other_axes_ = false;
};

}  // namespace

LiveSamples receive_samples(const system::System& system, double duration_s)
{
    const auto bus = bus::open(system.monitor.bus);
    if (!bus) fail(bus.error());
    runtime::SystemClock clock;
    runtime::EventLoop loop{**bus, clock, runtime::termination_requested()};
    Receiver receiver(system);
    bool room = true;
    loop.on((*bus)->subscribe(bus::topics::cluster), [&](const ClusterDescription& description) { receiver.on_description(description); });
    loop.on((*bus)->subscribe(bus::topics::frame), [&](const SensorFrame& frame) {
        room = room && receiver.on_frame(frame, clock.steady_ns());
        if (!room || receiver.other_axes()) loop.quit(ExitCode::refused);
    });
    const std::int64_t begin_ns = clock.steady_ns();
    loop.timer([&] { loop.quit(ExitCode::done); }).set(begin_ns + nanoseconds(duration_s));
    Progress progress;
    loop.every(shown_every_ns, [&] {
        progress.title(fmt::format("{} frames: let them rest, then turn them about all axes", receiver.frames()));
        progress.show(static_cast<std::size_t>((clock.steady_ns() - begin_ns) / shown_every_ns),
                      static_cast<std::size_t>(nanoseconds(duration_s) / shown_every_ns));
    });
    loop.run();
    std::signal(SIGINT, SIG_DFL);  // the fits can be ended
    std::signal(SIGTERM, SIG_DFL);
    if (receiver.other_axes()) fail("the publisher describes other axes since it started again: calibrate anew");
    if (receiver.frames() == 0) {
        fmt::print(stderr, "no frame of unit {} came in domain {} on '{}' in {} s\n", system.unit, system.monitor.bus.domain,
                   system.monitor.bus.interface, duration_s);
        throw Exit{ExitCode::not_as_asked};
    }
    auto result = receiver.result();
    if (!room || !result.samples.flush()) fail(no_room_for_samples);
    return result;
}

}  // namespace quorient::cli
