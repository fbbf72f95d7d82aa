#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::calibration {

/// Directions and gains that make all axes agree: measured = gain * (h'omega) + bias.
struct AxesFit {
    geometry::Axes axes;        ///< unit rows
    geometry::AxisVector gain;  ///< their mean is 1: a scale common to all axes cannot be seen
    double residual_rad_s = 0;  ///< rms over axes and samples, in units of the corrected axes
    std::size_t samples = 0;
};

/// The motion that axes are fitted to: the products of their rates, summed. A recording of any length takes the same room.
class RateMoment {
public:
    explicit RateMoment(Eigen::Index axes) : sum_(geometry::AxisMatrix::Zero(axes, axes)) {}

    /// @param rate  of every axis, without bias
    void add(const geometry::AxisVector& rate)
    {
        sum_ += rate * rate.transpose();
        ++samples_;
    }

    const geometry::AxisMatrix& sum() const { return sum_; }
    std::size_t samples() const { return samples_; }

private:
    geometry::AxisMatrix sum_;
    std::size_t samples_ = 0;
};

/// Least squares over rates without bias: the three directions in axis space that hold the motion (the eigenvectors of the samples' second
/// moment), turned, scaled and sheared to lie closest to the nominal axes. What the nominal axes have in common (a rotation of the
/// whole cluster, a common scale) is therefore kept from them.
/// @returns an error if the cluster has no redundancy, or the motion did not turn about all three body axes.
tl::expected<AxesFit, std::string> fit_axes(const RateMoment& motion, const geometry::Axes& nominal);

/// Nominal axes with every instrument turned by its rotation to the first one's frame; one that is within 10 deg stays as it is.
geometry::Axes turned(const geometry::Axes& nominal, const std::vector<std::size_t>& instrument, const std::vector<Eigen::Matrix3d>& to_first);

/// Nominal axes with every instrument of three or more axes turned to agree best with the first one (Wahba's problem by singular values
/// [Markley 1988]); instruments that are already within 10 deg stay as they are. For logs whose instruments each have a frame of their own.
/// Needs motion about at least two body axes: without, the turn about the one is arbitrary.
geometry::Axes mounted(const RateMoment& motion, const geometry::Axes& nominal, const std::vector<std::size_t>& instrument);

}  // namespace quorient::calibration
