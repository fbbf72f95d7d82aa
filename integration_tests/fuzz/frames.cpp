#include "bytes.hpp"
#include "quorient/attitude/integrator.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/fdi/methods.hpp"
#include "quorient/intake/frame_intake.hpp"
#include "quorient/messages/meaning.hpp"
#include "require.hpp"
#include "targets.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace quorient::fuzz {

namespace {

constexpr std::uint32_t unit = 1;
constexpr std::int64_t interval_ns = 5'000'000;

/// Up to eight axes on a cone; nine are three triads.
ClusterDescription description(std::uint64_t epoch, std::uint8_t axes)
{
    const std::size_t axes_of_instrument = axes > 8 ? 3 : 1;
    ClusterDescription made;
    made.epoch = epoch;
    made.revision = 1;
    made.unit = unit;
    made.kind = octet(SensorKind::gyro);
    made.axis_count = axes;
    made.instrument_count = static_cast<std::uint8_t>(axes / axes_of_instrument);
    made.interval_s = 0.005;
    for (std::size_t axis = 0; axis < axes; ++axis) {
        const double azimuth = 2 * 3.14159265358979 * static_cast<double>(axis) / axes;
        made.axis[axis] = {std::sqrt(2.0 / 3) * std::cos(azimuth), std::sqrt(2.0 / 3) * std::sin(azimuth), std::sqrt(1.0 / 3)};
        if (axes_of_instrument == 3) made.axis[axis] = {axis % 3 == 0 ? 1.0 : 0.0, axis % 3 == 1 ? 1.0 : 0.0, axis % 3 == 2 ? 1.0 : 0.0};
        made.instrument[axis] = static_cast<std::uint8_t>(axis / axes_of_instrument);
        made.sigma[axis] = 1e-6;
    }
    return made;
}

/// What stands behind the intake in the two processes of a lane.
class Lane {
public:
    Lane(std::string method, std::string algorithm)
    {
        detection_.method = std::move(method);
        integration_.algorithm = std::move(algorithm);
        integration_.history_s = 0.5;
    }

    void prepare(const ClusterDescription& described)
    {
        monitor_.reset();
        integrator_.reset();
        const auto cluster = geometry::make_cluster(described);
        if (!cluster) return;
        if (auto made = fdi::FaultMonitor::make(detection_, {}, *cluster)) monitor_ = std::move(*made);
        if (auto made = attitude::Integrator::make(integration_, *cluster)) integrator_.emplace(std::move(*made));
    }

    void handle(const SensorFrame& frame)
    {
        if (integrator_) integrator_->add(frame);
        if (monitor_) {
            const auto& verdict = monitor_->assess(frame);
            REQUIRE((verdict.isolated_mask & ~all_axes(frame.axis_count)) == 0);
            REQUIRE(verdict.candidate_count <= max_candidates);
            REQUIRE(verdict.state >= octet(VerdictState::warming_up) && verdict.state <= octet(VerdictState::saturated));
            if (integrator_) integrator_->apply(verdict);
        }
        if (!integrator_) return;
        while (integrator_->work()) continue;
        const auto state = integrator_->publish();
        double norm = 0;
        for (const double component : state.attitude) norm += component * component;
        REQUIRE(std::abs(norm - 1) < 1e-6);
    }

private:
    fdi::DetectorSettings detection_;
    attitude::IntegratorSettings integration_;
    std::optional<fdi::FaultMonitor> monitor_;
    std::optional<attitude::Integrator> integrator_;
};

}  // namespace

void frames(const std::uint8_t* data, std::size_t size)
{
    Bytes bytes{data, size};
    constexpr std::array<std::uint8_t, 7> axis_counts{3, 4, 5, 6, 7, 8, 9};
    constexpr std::array algorithms{"window-10", "block-4", "previous", "four-sample"};
    const auto axes = axis_counts[bytes.below(axis_counts.size())];
    const auto& method = fdi::methods()[bytes.below(static_cast<std::uint32_t>(fdi::methods().size()))].word;
    Lane lane{std::string{method}, algorithms[bytes.below(algorithms.size())]};
    intake::FrameIntake intake{unit, SensorKind::gyro};
    std::uint64_t epoch = 1, sequence = 0;
    std::int64_t now = 0;
    const auto describe = [&](bool well) {
        auto described = description(epoch, axes);
        if (!well) spoil_members(described, bytes);
        intake.describe(described);
    };
    describe(bytes.below(4) != 0);
    while (!bytes.empty()) {
        now += interval_ns;
        const auto what = bytes.below(32);
        if (what == 0) now += 1'000'000'000;
        if (what == 1) ++epoch, sequence = 0;
        if (what <= 2) describe(what != 2);
        SensorFrame frame;
        frame.epoch = epoch;
        frame.sequence = sequence++;
        frame.sample_time_ns = static_cast<std::int64_t>(sequence) * interval_ns;
        frame.interval_s = 0.005;
        frame.unit = unit;
        frame.kind = octet(SensorKind::gyro);
        frame.axis_count = axes;
        frame.valid_mask = all_axes(axes);
        frame.description_revision = 1;
        for (std::size_t axis = 0; axis < axes; ++axis) frame.increment[axis] = 1e-6 * (bytes.byte() - 128);
        if (what < 16) spoil_members(frame, bytes);
        intake.offer(frame, now);
        while (const auto* accepted = intake.next()) {
            if (accepted->new_description) lane.prepare(*intake.description());
            lane.handle(accepted->frame);
        }
        REQUIRE(intake.complaints() == 0 || !intake::words_for(intake.complaint()).empty());
    }
}

}  // namespace quorient::fuzz
