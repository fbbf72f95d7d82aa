#include "field/fast_lane.hpp"

#include <cmath>
#include <utility>

namespace quorient::fdi::field {
namespace {

/// So many times the calibration's standard deviation still confirm it.
constexpr double confirmed_times = 2;

}  // namespace

std::optional<FastLane> FastLane::make(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (!settings.motion_noise) return std::nullopt;
    DetectorSettings whole = settings;
    whole.instruments = true;
    auto detector = AccumulatingDetector::make(whole, cluster);
    if (!detector) return std::nullopt;
    const double variance = (cluster.sigma.cwiseAbs2() + cluster.quantum.cwiseAbs2() / 6).maxCoeff() / (cluster.interval_s * cluster.interval_s);
    const double most = confirmed_times * confirmed_times;
    return FastLane(std::move(*detector), most * variance, most * *settings.motion_noise * *settings.motion_noise);
}

FastLane::FastLane(std::unique_ptr<AccumulatingDetector> detector, double standing, double moving)
    : detector_(std::move(detector)), standing_(standing), moving_(moving)
{
}

void FastLane::assess(const Measurement& measurement)
{
    detector_->assess(measurement, assessment_);
    named_[2] = named_[1];
    named_[1] = named_[0];
    named_[0] = assessment_.outcome == Outcome::isolated ? assessment_.isolated : 0;
}

void FastLane::reset()
{
    detector_->reset();
    assessment_ = {};
    named_.fill(0);
}

std::optional<FastLane::Finding> FastLane::finding(const NoiseScale& noise, InstrumentSet compared) const
{
    const bool repeated = named_[0] != 0 && (named_[0] == named_[1] || named_[0] == named_[2]);
    if (!repeated || !noise.is_within(standing_, moving_, compared)) return std::nullopt;
    return Finding{named_[0], assessment_.onset};
}

}  // namespace quorient::fdi::field
