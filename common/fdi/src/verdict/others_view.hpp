#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace quorient::fdi {

/// What the other instruments say of an axis, whichever one of them is faulty: the least and the largest of the estimates that leave out the
/// axis's own instrument and one more. Where these do not span space, only its own instrument is left out, else only the axis itself.
///
/// Allocates nothing after construction.
class OthersView {
public:
    explicit OthersView(const geometry::SensorCluster& cluster);

    /// @param used  axes to look at, all with a finite increment.
    void update(const Measurement& measurement, AxisMask used);

    struct Range {
        bool known = false;
        bool independent = false;  ///< holds whichever one of the others is faulty
        double low = 0;  ///< [rad/s; m/s^2]
        double high = 0;
    };
    const Range& of(std::size_t axis) const { return of_[axis]; }

private:
    /// One estimate of the body's rate from all axes but some.
    struct Estimate {
        AxisMask without = 0;
        bool spans = false;
        Eigen::Matrix3d inverse;
        Eigen::Vector3d rate;
    };

    void add(AxisMask without);
    void prepare(AxisMask used);
    std::size_t estimate_without(AxisMask axes) const;
    Range range_of(std::size_t axis) const;

    geometry::SensorCluster cluster_;
    AxisMask used_ = 0;
    std::vector<AxisMask> instruments_;
    std::vector<Estimate> estimates_;
    std::array<std::vector<std::size_t>, max_axes> pairs_{};         ///< per axis: its own instrument and one more
    std::array<std::array<std::size_t, 2>, max_axes> wider_{};       ///< per axis: its own instrument; itself
    std::array<Range, max_axes> of_{};
};

}  // namespace quorient::fdi
