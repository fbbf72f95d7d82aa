#include "quorient/calibration/rest.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::calibration {
namespace {

using geometry::AxisVector;

constexpr double flicker_floor = 0.664;  // sqrt(2 ln 2 / pi): the flat part of flicker noise lies at this multiple of the instability

/// Angles at the sample times of a segment, beginning with 0.
std::vector<AxisVector> angles(Samples samples, const Segment& segment)
{
    std::vector<AxisVector> angle{AxisVector::Zero(samples[segment.begin].rate.size())};
    angle.reserve(segment.size() + 1);
    for (const Sample& sample : samples.subspan(segment.begin, segment.size()))
        angle.emplace_back(angle.back() + sample.rate * sample.interval_s);
    return angle;
}

}  // namespace

std::vector<AllanPoint> allan_deviation(Samples samples, const std::vector<Segment>& segments)
{
    std::vector<std::vector<AxisVector>> angle;
    std::size_t longest = 0;
    double interval_s = 0;
    std::size_t count = 0;
    for (const Segment& segment : segments) {
        angle.push_back(angles(samples, segment));
        longest = std::max(longest, segment.size());
        for (const Sample& sample : samples.subspan(segment.begin, segment.size())) interval_s += sample.interval_s;
        count += segment.size();
    }
    interval_s /= static_cast<double>(count);

    std::vector<AllanPoint> points;
    for (std::size_t m = 1; 3 * m <= longest; m *= 2) {
        AllanPoint point{static_cast<double>(m) * interval_s, AxisVector::Zero(angle.front().front().size()), 0};
        for (const auto& theta : angle) {
            for (std::size_t k = 0; k + 2 * m < theta.size(); ++k) {
                point.deviation_rad_s += (theta[k + 2 * m] - 2.0 * theta[k + m] + theta[k]).cwiseAbs2();
                ++point.terms;
            }
        }
        point.deviation_rad_s = (point.deviation_rad_s / (2.0 * static_cast<double>(point.terms))).cwiseSqrt() / point.tau_s;
        points.push_back(point);
    }
    return points;
}

AllanFigures allan_figures(const std::vector<AllanPoint>& points)
{
    const Eigen::Index axes = points.front().deviation_rad_s.size();
    AllanFigures figures{AxisVector::Zero(axes), AxisVector::Zero(axes)};
    const std::size_t first = std::min<std::size_t>(4, points.size());
    for (Eigen::Index axis = 0; axis < axes; ++axis) {
        std::vector<double> walk;
        double smallest = points.front().deviation_rad_s(axis);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (i < first) walk.push_back(points[i].deviation_rad_s(axis) * std::sqrt(points[i].tau_s));
            smallest = std::min(smallest, points[i].deviation_rad_s(axis));
        }
        std::sort(walk.begin(), walk.end());
        figures.random_walk_rad_sqrt_s(axis) = (walk[(first - 1) / 2] + walk[first / 2]) / 2.0;
        figures.bias_instability_rad_s(axis) = smallest / flicker_floor;
    }
    return figures;
}

}  // namespace quorient::calibration
