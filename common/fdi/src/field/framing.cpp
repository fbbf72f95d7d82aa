#include "field/framing.hpp"

#include "quorient/rotation/nearest.hpp"

#include <Eigen/Dense>

namespace quorient::fdi::field {
namespace {

/// The rotation closest to the axes of this instrument.
Eigen::Matrix3d frame_along(const geometry::SensorCluster& cluster, const InstrumentArray::Instrument& instrument)
{
    if (instrument.size != 3) return Eigen::Matrix3d::Identity();
    Eigen::Matrix3d rows;
    for (Eigen::Index i = 0; i < 3; ++i)
        rows.row(i) = cluster.axes.row(static_cast<Eigen::Index>(instrument.axis[static_cast<std::size_t>(i)]));
    return rotation::nearest_orthogonal(rows);
}

InstrumentSet present_in(const Measurement& measurement, const InstrumentArray& array)
{
    InstrumentSet present;
    for (std::size_t m = 0; m < array.size(); ++m) present.set(m, measurement.usable_of(array[m].mask) == array[m].mask);
    return present;
}

}  // namespace

Framing::Framing(const geometry::SensorCluster& cluster, const InstrumentArray& array)
    : array_(array),
      common_from_body_(frame_along(cluster, array[0])),
      axes_(cluster.axes * common_from_body_.transpose()),
      grid_(cluster.interval_s)
{
}

void Framing::begin(const Measurement& measurement)
{
    building_.sequence = measurement.identity.sequence;
    building_.interval_s = 0;
    building_.present = InstrumentSet::first(array_.size());
    building_.near_range = 0;
    building_.rate.setZero(3, static_cast<Eigen::Index>(array_.size()));
}

bool Framing::add(const Measurement& measurement)
{
    if (!(measurement.interval_s > 0)) return false;
    if (grid_.begins(measurement)) begin(measurement);
    building_.present = building_.present & present_in(measurement, array_);
    building_.near_range |= array_.near_range(measurement);
    building_.rate += array_.body_vectors(measurement);
    building_.interval_s += measurement.interval_s;
    if (!grid_.completes()) return false;

    frame_ = building_;
    frame_.rate = common_from_body_ * building_.rate / building_.interval_s;
    frame_.follows = grid_.follows();
    return true;
}

}  // namespace quorient::fdi::field
