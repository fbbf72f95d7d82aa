#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <array>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::fdi {

/// Instruments that each measure all three directions, and what each of them says of the body's turn in one frame.
class InstrumentArray {
public:
    static constexpr std::size_t max_instruments = max_axes / 3;

    using BodyVectors = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_instruments)>;

    struct Instrument {
        std::array<std::size_t, max_axes> axis{};
        std::size_t size = 0;
        AxisMask mask = 0;
        Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_axes)> body_from_axes;  ///< B_m
        Eigen::Matrix3d covariance;  ///< C_m, of one increment at rest
        std::size_t kind = 0;        ///< place of the first instrument of this covariance: what depends on it alone is reckoned once
    };

    /// @param variance  of one increment at rest, per axis.
    /// @returns why not: fewer than two instruments, or one that does not span space.
    static tl::expected<InstrumentArray, std::string> make(const geometry::SensorCluster& cluster, const geometry::AxisVector& variance);

    std::size_t size() const { return instruments_.size(); }
    const Instrument& operator[](std::size_t place) const { return instruments_[place]; }

    /// An instrument that has lost an axis is no longer compared.
    void exclude(AxisMask excluded) { excluded_ = excluded; }
    bool compared(std::size_t place) const { return (instruments_[place].mask & excluded_) == 0; }
    std::size_t compared_count() const;

    /// Whether every axis that is compared has a finite value in this frame.
    bool complete(const Measurement& measurement) const;

    /// theta_m = B_m z_m, one column per instrument; 0 where it is not compared.
    BodyVectors body_vectors(const Measurement& measurement) const;

    /// Axes that are compared and closer than 2.5 % to their range, or beyond it.
    AxisMask near_range(const Measurement& measurement) const;

    /// Covariance of an increment that is known only up to what these axes may lie beyond their range.
    Eigen::Matrix3d blindness(AxisMask saturated, double interval_s) const;

    const Eigen::Matrix3d& mean_covariance() const { return mean_covariance_; }    ///< C
    const Eigen::Matrix3d& mean_information() const { return mean_information_; }  ///< C^-1

private:
    InstrumentArray() = default;

    std::vector<Instrument> instruments_;
    geometry::AxisVector range_;  ///< rad/s, 0 = unknown
    AxisMask excluded_ = 0;
    Eigen::Matrix3d mean_covariance_ = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d mean_information_ = Eigen::Matrix3d::Zero();
};

}  // namespace quorient::fdi
