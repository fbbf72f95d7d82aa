#pragma once

#include "skewed/axis_frames.hpp"

namespace quorient::fdi::skewed {

/// Where the motion goes beyond the axes' ranges. An axis at its range is believed only if it is borne out: by another one at its range, or
/// by a rate of the others near it. Alone and not borne out it is ordinary data, i.e. a fault.
class AxisSaturation {
public:
    explicit AxisSaturation(const geometry::SensorCluster& cluster) : cluster_(cluster) {}

    /// @param rate_without  the body's rate without an axis [rad/s]
    template <class RateWithout>
    void update(const AxisFrame& frame, AxisSet compared, RateWithout rate_without)
    {
        for (std::size_t i = 0; i < cluster_.size(); ++i) {
            const bool near = frame.near_range.has(i) && compared.has(i) && frame.present.has(i);
            if (near && borne_out(i, frame, compared, rate_without(i))) blind_frames_[i] = frames_blinded;
            else if (blind_frames_[i] > 0) --blind_frames_[i];
        }
    }

    /// These axes say nothing in the newest frame: they are, or have just been, beyond their range.
    AxisSet blind() const
    {
        AxisSet set;
        for (std::size_t i = 0; i < cluster_.size(); ++i) set.set(i, blind_frames_[i] > 0);
        return set;
    }

    void reset() { blind_frames_.fill(0); }

private:
    /// The frame itself and the three after it, whose derivatives it spoils.
    static constexpr unsigned frames_blinded = 4;

    bool borne_out(std::size_t axis, const AxisFrame& frame, AxisSet compared, const Eigen::Vector3d& rate) const;

    const geometry::SensorCluster& cluster_;
    std::array<unsigned, max_axes> blind_frames_{};
};

}  // namespace quorient::fdi::skewed
