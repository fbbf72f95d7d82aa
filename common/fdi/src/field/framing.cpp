#include "field/framing.hpp"

#include <Eigen/Dense>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace quorient::fdi::field {
namespace {

constexpr double longest_frame_s = 0.0105;

/// An interval this many times the nominal one hides a lost measurement.
constexpr double gap_intervals = 1.7;

/// The rotation closest to the axes of this instrument.
Eigen::Matrix3d frame_along(const geometry::SensorCluster& cluster, const InstrumentArray::Instrument& instrument)
{
    if (instrument.size != 3) return Eigen::Matrix3d::Identity();
    Eigen::Matrix3d rows;
    for (Eigen::Index i = 0; i < 3; ++i)
        rows.row(i) = cluster.axes.row(static_cast<Eigen::Index>(instrument.axis[static_cast<std::size_t>(i)]));
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rows, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return svd.matrixU() * svd.matrixV().transpose();
}

InstrumentSet present_in(const Measurement& measurement, const InstrumentArray& array)
{
    InstrumentSet present;
    for (std::size_t m = 0; m < array.size(); ++m) {
        const auto& instrument = array[m];
        bool complete = (measurement.valid & instrument.mask) == instrument.mask;
        for (std::size_t i = 0; complete && i < instrument.size; ++i) complete = std::isfinite(measurement.increment[instrument.axis[i]]);
        present.set(m, complete);
    }
    return present;
}

}  // namespace

Framing::Framing(const geometry::SensorCluster& cluster, const InstrumentArray& array)
    : array_(array),
      common_from_body_(frame_along(cluster, array[0])),
      axes_(cluster.axes * common_from_body_.transpose()),
      measurement_interval_s_(cluster.interval_s),
      measurements_per_frame_(std::max<std::size_t>(1, static_cast<std::size_t>(longest_frame_s / cluster.interval_s))),
      interval_s_(cluster.interval_s * static_cast<double>(measurements_per_frame_))
{
}

void Framing::reset()
{
    collected_ = 0;
    gap_ = true;
}

void Framing::begin(const Measurement& measurement, bool follows)
{
    if (!follows) gap_ = true;
    building_.sequence = measurement.identity.sequence;
    building_.interval_s = 0;
    building_.present = InstrumentSet::first(array_.size());
    building_.near_range = 0;
    building_.rate.setZero(3, static_cast<Eigen::Index>(array_.size()));
    collected_ = 0;
}

bool Framing::add(const Measurement& measurement)
{
    if (!(measurement.interval_s > 0)) return false;
    const bool follows =
        measurement.identity.sequence == next_sequence_ && measurement.interval_s < gap_intervals * measurement_interval_s_;
    next_sequence_ = measurement.identity.sequence + 1;
    if (collected_ == 0 || !follows) begin(measurement, follows);
    building_.present = building_.present & present_in(measurement, array_);
    building_.near_range |= array_.near_range(measurement);
    building_.rate += array_.body_vectors(measurement);
    building_.interval_s += measurement.interval_s;
    if (++collected_ < measurements_per_frame_) return false;

    frame_ = building_;
    frame_.rate = common_from_body_ * building_.rate / building_.interval_s;
    frame_.follows = !gap_;
    gap_ = false;
    collected_ = 0;
    return true;
}

}  // namespace quorient::fdi::field
