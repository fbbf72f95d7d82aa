#pragma once

#include "coning.hpp"
#include "quorient/attitude/body_increment.hpp"
#include "quorient/attitude/integrator.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/messages/meaning.hpp"

#include <functional>
#include <random>
#include <string>
#include <vector>

namespace quorient::attitude::testing {

/// Every layout of the catalogue, and members of its families.
inline std::vector<std::string> all_layouts()
{
    std::vector<std::string> names;
    for (const auto& entry : geometry::catalogue())
        if (geometry::layout(entry.name)) names.push_back(entry.name);
    for (const char* member : {"cone-7", "cone-axis-5", "two-cones:52.6226,10.8123,60", "two-triads:1,1,1,60", "triads-4", "triads-8"})
        names.emplace_back(member);
    return names;
}

inline geometry::SensorCluster cluster_of(const std::string& name, double interval_s, double sigma_rad = 0)
{
    geometry::SensorCluster cluster = geometry::layout(name).value();
    cluster.interval_s = interval_s;
    cluster.sigma = geometry::AxisVector::Constant(cluster.axes.rows(), sigma_rad);
    return cluster;
}

/// What a fault makes of an increment: (true increment, frames since onset) -> measured.
using Distortion = std::function<double(double, std::uint64_t)>;

/// Frames of a cluster on a coning body, frame by frame, with one faulty axis.
class Instrument {
public:
    Instrument(const geometry::SensorCluster& cluster, const ClassicConing& motion) : cluster_(cluster), motion_(motion) {}

    void set_fault(std::size_t axis, std::uint64_t onset, Distortion distortion)
    {
        faulty_ = axis;
        onset_ = onset;
        distortion_ = std::move(distortion);
    }

    void set_noise(double sigma_rad, std::uint64_t seed)
    {
        noise_ = sigma_rad;
        random_.seed(seed);
    }

    SensorFrame next()
    {
        const double h = cluster_.interval_s;
        SensorFrame frame;
        frame.epoch = 1;
        frame.sequence = sequence_;
        frame.interval_s = h;
        frame.sample_time_ns = static_cast<std::int64_t>(std::llround(h * 1e9)) * static_cast<std::int64_t>(sequence_ + 1);
        frame.kind = octet(SensorKind::gyro);
        frame.axis_count = static_cast<std::uint8_t>(cluster_.size());
        frame.valid_mask = cluster_.all();
        const Eigen::Vector3d body = motion_.increment(static_cast<Wide>(sequence_) * h, h);
        for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
            double z = cluster_.axes.row(static_cast<Eigen::Index>(axis)).dot(body) + (noise_ > 0 ? noise_ * normal_(random_) : 0);
            if (distortion_ && axis == faulty_ && sequence_ >= onset_) z = distortion_(z, sequence_ - onset_);
            frame.increment[axis] = z;
            accumulated_[axis] += z;
        }
        frame.accumulated = accumulated_;
        ++sequence_;
        return frame;
    }

    Quaternion attitude_after(std::uint64_t sequence) const
    {
        return motion_.attitude(static_cast<Wide>(sequence + 1) * cluster_.interval_s);
    }

private:
    const geometry::SensorCluster& cluster_;
    ClassicConing motion_;
    std::size_t faulty_ = 0;
    std::uint64_t onset_ = 0;
    Distortion distortion_;
    double noise_ = 0;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    std::array<double, max_axes> accumulated_{};
    std::uint64_t sequence_ = 0;
};

inline std::vector<SensorFrame> record(Instrument instrument, std::size_t count)
{
    std::vector<SensorFrame> frames(count);
    for (auto& frame : frames) frame = instrument.next();
    return frames;
}

inline FaultVerdict verdict_on(std::uint64_t sequence, VerdictState state = VerdictState::healthy)
{
    FaultVerdict verdict;
    verdict.epoch = 1;
    verdict.sequence = sequence;
    verdict.kind = octet(SensorKind::gyro);
    verdict.state = octet(state);
    return verdict;
}

inline FaultVerdict isolating(std::uint64_t sequence, std::size_t axis, std::uint64_t from)
{
    FaultVerdict verdict = verdict_on(sequence, VerdictState::isolated);
    verdict.excluded_from[axis] = from;
    verdict.isolated_mask = axis_bit(axis);
    return verdict;
}

inline FaultVerdict suspecting(std::uint64_t sequence, AxisMask axes)
{
    FaultVerdict verdict = verdict_on(sequence, VerdictState::suspect);
    verdict.suspect_mask = axes;
    return verdict;
}

/// Settings with which an integrator starts at the true attitude.
inline IntegratorSettings settings_for(const ClassicConing& motion, double history_s, bool rollback = true)
{
    IntegratorSettings settings;
    settings.history_s = history_s;
    settings.rollback = rollback;
    settings.initial_attitude = to_array(motion.attitude(0));
    return settings;
}

template <class AnyIntegrator>
void finish(AnyIntegrator& integrator)
{
    while (integrator.work()) {
    }
}

inline double angle_to(const AttitudeState& state, const Quaternion& truth)
{
    return angle_between(from_array(state.attitude), truth);
}

}  // namespace quorient::attitude::testing
