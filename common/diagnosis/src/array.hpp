#pragma once

#include "mounting.hpp"

#include "quorient/diagnosis/diagnose.hpp"
#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <vector>

namespace quorient::diagnosis {

/// The compared instruments as the detector sees them: mountings found, wrong units undone, a reference's biases and gains taken out.
class Array {
public:
    Array(const Mountings& mountings, const std::vector<recording::SurveyedInstrument>& instruments, const std::vector<Calibration>& reference,
          double interval_s);

    const geometry::SensorCluster& cluster() const { return cluster_; }
    std::size_t instruments() const { return of_.size(); }
    bool calibrated() const { return calibrated_; }  ///< all of them, by the reference

    /// What instrument m measures along its own axes [rad/s].
    Eigen::Vector3d measured(const recording::AlignedFrame& frame, std::size_t m) const;

    /// The same along the common axes.
    Eigen::Vector3d common(const recording::AlignedFrame& frame, std::size_t m) const { return of_[m].turned * measured(frame, m); }

    /// A rate of the common frame, along the axes of instrument m.
    Eigen::Vector3d own_axes(std::size_t m, const Eigen::Vector3d& rate) const { return of_[m].turned.transpose() * rate; }

    /// For the detector. The view lives until the next call.
    fdi::Measurement measurement(const recording::AlignedFrame& frame, std::uint64_t sequence);

private:
    struct One {
        Eigen::Matrix3d turned;
        double scale = 1;
        Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
        Eigen::Matrix3d inverse_gain = Eigen::Matrix3d::Identity();
    };

    std::vector<One> of_;
    geometry::SensorCluster cluster_;
    bool calibrated_ = false;
    std::array<double, max_axes> increments_{};
};

}  // namespace quorient::diagnosis
