#include "quorient/calibration/rest.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::calibration {
namespace {

using geometry::AxisVector;

constexpr double flicker_floor = 0.664;  // sqrt(2 ln 2 / pi): the flat part of flicker noise lies at this multiple of the instability

/// The angles at the sample times of a segment one after the other, beginning with 0.
class Angles {
public:
    Angles(Samples samples, const Segment& segment)
        : samples_(samples.subspan(segment.begin, segment.size())), angle_(AxisVector::Zero(samples[segment.begin].rate.size()))
    {
    }

    const AxisVector& angle() const { return angle_; }

    void advance()
    {
        const Sample sample = samples_[next_++];
        angle_ += sample.rate * sample.interval_s;
    }

    void advance(std::size_t count)
    {
        for (std::size_t i = 0; i < count; ++i) advance();
    }

private:
    Samples samples_;
    AxisVector angle_;
    std::size_t next_ = 0;
};

/// Adds the squared second differences of a segment's angles, m samples apart.
void add_terms(Samples samples, const Segment& segment, std::size_t m, AllanPoint& point)
{
    if (segment.size() < 2 * m) return;
    Angles end(samples, segment);
    end.advance(2 * m);
    Angles middle(samples, segment);
    middle.advance(m);
    Angles begin(samples, segment);
    for (std::size_t last = 2 * m;; ++last) {
        point.deviation_rad_s += (end.angle() - 2.0 * middle.angle() + begin.angle()).cwiseAbs2();
        ++point.terms;
        if (last == segment.size()) return;
        for (Angles* const angles : {&end, &middle, &begin}) angles->advance();
    }
}

}  // namespace

std::vector<AllanPoint> allan_deviation(Samples samples, const std::vector<Segment>& segments)
{
    std::size_t longest = 0;
    double interval_s = 0;
    std::size_t count = 0;
    for (const Segment& segment : segments) {
        longest = std::max(longest, segment.size());
        for (const Sample& sample : samples.subspan(segment.begin, segment.size())) interval_s += sample.interval_s;
        count += segment.size();
    }
    interval_s /= static_cast<double>(count);
    const Eigen::Index axes = samples[segments.front().begin].rate.size();

    std::vector<AllanPoint> points;
    for (std::size_t m = 1; 3 * m <= longest; m *= 2) {
        AllanPoint point{static_cast<double>(m) * interval_s, AxisVector::Zero(axes), 0};
        for (const Segment& segment : segments) add_terms(samples, segment, m, point);
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
