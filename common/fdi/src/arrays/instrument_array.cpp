#include "quorient/fdi/instrument_array.hpp"

#include "near_range.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace quorient::fdi {
namespace {

/// An axis near its range may be beyond it, by a standard deviation of this times its range.
constexpr double excess = 0.5;

/// Two covariances that differ by less, as a share, are those of the same axes in other directions.
constexpr double covariance_rounding = 1e-12;

void weigh(const geometry::SensorCluster& cluster, const geometry::AxisVector& variance, InstrumentArray::Instrument& instrument)
{
    const auto n = static_cast<Eigen::Index>(instrument.size);
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_axes)> weighted(3, n);
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto axis = static_cast<Eigen::Index>(instrument.axis[static_cast<std::size_t>(i)]);
        weighted.col(i) = cluster.axes.row(axis).transpose() / variance(axis);
        information += weighted.col(i) * cluster.axes.row(axis);
    }
    instrument.covariance = information.inverse();
    instrument.body_from_axes = instrument.covariance * weighted;
}

/// Place of the first instrument with the covariance of this one, which is in the list and weighed, as all before it.
std::size_t first_alike(const std::vector<InstrumentArray::Instrument>& instruments, const InstrumentArray::Instrument& instrument)
{
    const auto alike = [&](const auto& other) { return other.covariance.isApprox(instrument.covariance, covariance_rounding); };
    return static_cast<std::size_t>(std::find_if(instruments.begin(), instruments.end(), alike) - instruments.begin());
}

}  // namespace

tl::expected<InstrumentArray, std::string> InstrumentArray::make(const geometry::SensorCluster& cluster,
                                                                 const geometry::AxisVector& variance)
{
    InstrumentArray array;
    array.range_ = cluster.range;
    array.instruments_.resize(1 + *std::max_element(cluster.instrument.begin(), cluster.instrument.end()));
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        Instrument& instrument = array.instruments_[cluster.instrument[axis]];
        instrument.axis[instrument.size++] = axis;
        instrument.mask |= axis_bit(axis);
    }
    std::erase_if(array.instruments_, [](const Instrument& instrument) { return instrument.size == 0; });
    if (array.size() < 2) return tl::unexpected(std::string("needs two or more instruments, this cluster has one"));
    for (Instrument& instrument : array.instruments_) {
        if (geometry::rank_of(cluster.axes, instrument.mask) < 3)
            return tl::unexpected(
                std::string("compares instruments that each measure all three directions; these axes do not: use glt or subset"));
        weigh(cluster, variance, instrument);
        instrument.kind = first_alike(array.instruments_, instrument);
        array.mean_covariance_ += instrument.covariance / static_cast<double>(array.size());
    }
    array.mean_information_ = array.mean_covariance_.inverse();
    return array;
}

std::size_t InstrumentArray::compared_count() const
{
    std::size_t count = 0;
    for (std::size_t m = 0; m < size(); ++m) count += compared(m) ? 1 : 0;
    return count;
}

bool InstrumentArray::complete(const Measurement& measurement) const
{
    for (std::size_t m = 0; m < size(); ++m)
        if (compared(m) && measurement.usable_of(instruments_[m].mask) != instruments_[m].mask) return false;
    return true;
}

InstrumentArray::BodyVectors InstrumentArray::body_vectors(const Measurement& measurement) const
{
    BodyVectors body = BodyVectors::Zero(3, static_cast<Eigen::Index>(size()));
    for (std::size_t m = 0; m < size(); ++m) {
        if (!compared(m)) continue;
        for (std::size_t i = 0; i < instruments_[m].size; ++i)
            body.col(static_cast<Eigen::Index>(m)) +=
                instruments_[m].body_from_axes.col(static_cast<Eigen::Index>(i)) * measurement.increment[instruments_[m].axis[i]];
    }
    return body;
}

AxisMask InstrumentArray::near_range(const Measurement& measurement) const
{
    AxisMask near = 0;
    for (std::size_t m = 0; m < size(); ++m) {
        if (!compared(m)) continue;
        for (std::size_t i = 0; i < instruments_[m].size; ++i) {
            const std::size_t axis = instruments_[m].axis[i];
            if (is_near_range(measurement.increment[axis], range_(static_cast<Eigen::Index>(axis)), measurement.interval_s)) near |= axis_bit(axis);
        }
    }
    return near;
}

Eigen::Matrix3d InstrumentArray::blindness(AxisMask saturated, double interval_s) const
{
    Eigen::Matrix3d blind = Eigen::Matrix3d::Zero();
    for (std::size_t m = 0; m < size(); ++m) {
        if (!compared(m) || (instruments_[m].mask & saturated) == 0) continue;
        for (std::size_t i = 0; i < instruments_[m].size; ++i) {
            const std::size_t axis = instruments_[m].axis[i];
            if (!has_axis(saturated, axis)) continue;
            const double unknown = excess * range_(static_cast<Eigen::Index>(axis)) * interval_s;
            const Eigen::Vector3d along = unknown * instruments_[m].body_from_axes.col(static_cast<Eigen::Index>(i));
            blind += along * along.transpose();
        }
    }
    return blind;
}

}  // namespace quorient::fdi
