#pragma once

#include "quorient/messages/units.hpp"
#include "quorient/recording/resampler.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace quorient::diagnosis {

/// All three axes of this instrument have data in the frame.
inline bool has_triad(const recording::AlignedFrame& frame, std::size_t m)
{
    return (frame.valid_mask >> (3 * m) & 7U) == 7U;
}

/// Along the instrument's own axes.
inline Eigen::Vector3d rate_of(const recording::AlignedFrame& frame, std::size_t m)
{
    return {frame.rate_rad_s[m][0], frame.rate_rad_s[m][1], frame.rate_rad_s[m][2]};
}

/// The middle value, of an even number the mean of the two middle ones. Not empty.
inline double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace quorient::diagnosis
