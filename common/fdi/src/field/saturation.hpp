#pragma once

#include "field/framing.hpp"

namespace quorient::fdi::field {

/// Where the motion goes beyond the instruments' ranges. An axis at its range is believed only if it is borne out: by another instrument at its
/// range, or by a consensus near it. Alone and not borne out it is ordinary data, i.e. a fault.
class Saturation {
public:
    /// @param axes  in the common frame
    Saturation(const geometry::SensorCluster& cluster, const geometry::Axes& axes);

    /// @param consensus  the body's rate in this frame [rad/s]
    void update(const Frame& frame, InstrumentSet compared, const Eigen::Vector3d& consensus);

    /// This component says nothing in the newest frame: an axis along it is, or has just been, beyond its range.
    bool blinds(std::size_t component) const { return blind_frames_[component] > 0; }

    /// All instruments are at their range along one direction: none is faulty, and the body's rate is unknown.
    bool is_common() const { return common_; }

    /// At their range in this frame, borne out, while those that are not measure more than that range along the same direction. Where all ranges
    /// are alike, some reach theirs a little before others, and what they measure is as good.
    InstrumentSet limited() const { return limited_; }

    void reset();

private:
    bool borne_out(std::size_t axis, const Frame& frame, InstrumentSet compared, const Eigen::Vector3d& consensus) const;
    bool is_exceeded(std::size_t axis, const Frame& frame, InstrumentSet compared) const;

    const geometry::SensorCluster& cluster_;
    const geometry::Axes& axes_;
    std::array<unsigned, component_count> blind_frames_{};
    InstrumentSet limited_;
    bool common_ = false;
};

}  // namespace quorient::fdi::field
