#include "array.hpp"

#include "rates.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace quorient::diagnosis {

Array::Array(const Mountings& mountings, const std::vector<recording::SurveyedInstrument>& instruments, const std::vector<Calibration>& reference,
             double interval_s)
{
    const std::size_t count = mountings.of.size();
    const auto axes = static_cast<Eigen::Index>(3 * count);
    cluster_.axes.resize(axes, 3);
    cluster_.sigma.setZero(axes);
    cluster_.quantum.setZero(axes);
    cluster_.range.setZero(axes);
    cluster_.interval_s = interval_s;
    calibrated_ = true;
    for (std::size_t m = 0; m < count; ++m) {
        One one{mountings.of[m].turned, mountings.of[m].scale};
        const auto known = std::find_if(reference.begin(), reference.end(),
                                        [&](const Calibration& c) { return c.name == instruments[m].instrument.name; });
        calibrated_ = calibrated_ && known != reference.end();
        if (known != reference.end()) {
            one.turned = known->turned;
            one.bias_rad_s = known->bias_rad_s;
            one.inverse_gain = known->gain.inverse();
        }
        const auto first = static_cast<Eigen::Index>(3 * m);
        cluster_.axes.middleRows(first, 3) = one.turned.transpose();
        for (Eigen::Index k = 0; k < 3; ++k) cluster_.range(first + k) = instruments[m].range_rad_s(static_cast<std::size_t>(k)) / one.scale;
        cluster_.instrument.insert(cluster_.instrument.end(), 3, m);
        cluster_.instrument_name.push_back(instruments[m].instrument.name);
        of_.push_back(one);
    }
}

Eigen::Vector3d Array::measured(const recording::AlignedFrame& frame, std::size_t m) const
{
    return of_[m].inverse_gain * (rate_of(frame, m) / of_[m].scale - of_[m].bias_rad_s);
}

fdi::Measurement Array::measurement(const recording::AlignedFrame& frame, std::uint64_t sequence)
{
    AxisMask valid = 0;
    for (std::size_t m = 0; m < of_.size(); ++m) {
        if (!has_triad(frame, m)) continue;
        valid |= AxisMask{7} << (3 * m);
        const Eigen::Vector3d increment = measured(frame, m) * frame.interval_s;
        for (std::size_t i = 0; i < 3; ++i) increments_[3 * m + i] = increment(static_cast<Eigen::Index>(i));
    }
    return {.identity = {1, sequence}, .interval_s = frame.interval_s, .increment = std::span(increments_).first(3 * of_.size()), .valid = valid};
}

}  // namespace quorient::diagnosis
