#include "quorient/calibration/rest.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::calibration {
namespace {

using geometry::AxisVector;

struct Window {
    Segment place;
    AxisVector mean;
    double variance = 0;  // mean over the axes
    bool whole = false;
};

Window judge(Samples samples, Segment place)
{
    Window window{place, AxisVector::Zero(samples[place.begin].rate.size()), 0, true};
    for (std::size_t i = place.begin; i < place.end; ++i) {
        const Sample sample = samples[i];
        window.whole = window.whole && sample.complete && (sample.follows || i == place.begin);
        window.mean += sample.rate;
    }
    window.mean /= static_cast<double>(place.size());
    for (std::size_t i = place.begin; i < place.end; ++i)
        window.variance += (samples[i].rate - window.mean).squaredNorm() /
                           static_cast<double>(place.size() * static_cast<std::size_t>(window.mean.size()));
    return window;
}

std::vector<Window> windows_of(Samples samples, double window_s)
{
    std::vector<Window> windows;
    if (samples.empty()) return windows;
    const auto length = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(window_s / samples.front().interval_s)));
    for (std::size_t begin = 0; begin + length <= samples.size(); begin += length)
        windows.push_back(judge(samples, {begin, begin + length}));
    return windows;
}

double quantile(std::vector<double> values, double fraction)
{
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

AxisVector median_mean(const std::vector<Window>& windows, double variance_limit)
{
    AxisVector median = windows.front().mean;
    for (Eigen::Index axis = 0; axis < median.size(); ++axis) {
        std::vector<double> means;
        for (const Window& window : windows)
            if (window.whole && window.variance <= variance_limit) means.push_back(window.mean(axis));
        if (!means.empty()) median(axis) = quantile(std::move(means), 0.5);
    }
    return median;
}

}  // namespace

std::vector<Segment> resting_segments(Samples samples, const RestSettings& settings)
{
    const auto windows = windows_of(samples, settings.window_s);
    std::vector<double> variances;
    for (const Window& window : windows)
        if (window.whole) variances.push_back(window.variance);
    if (variances.empty()) return {};
    const double limit =
        std::min(settings.deviation_rad_s * settings.deviation_rad_s, settings.quiet_factor * quantile(std::move(variances), 0.1));
    const AxisVector usual = median_mean(windows, limit);

    std::vector<Segment> segments;
    const std::size_t margin = windows.front().place.size() / 2;  // motion that begins or ends within the neighbouring window
    Segment current;
    const auto close = [&] {
        const double duration_s = static_cast<double>(current.size()) * samples.front().interval_s;
        if (duration_s >= settings.shortest_s) segments.push_back({current.begin + margin, current.end - margin});
        current = {};
    };
    for (const Window& window : windows) {
        const bool rests =
            window.whole && window.variance <= limit && (window.mean - usual).lpNorm<Eigen::Infinity>() <= settings.mean_rad_s;
        const bool continues = current.size() > 0 && samples[window.place.begin].follows;
        if (!rests || !continues) close();
        if (!rests) continue;
        if (current.size() == 0) current.begin = window.place.begin;
        current.end = window.place.end;
    }
    close();
    return segments;
}

RestFigures rest_figures(Samples samples, const std::vector<Segment>& segments)
{
    const Eigen::Index axes = samples[segments.front().begin].rate.size();
    std::vector<AxisVector> means;
    RestFigures figures{AxisVector::Zero(axes), AxisVector::Zero(axes), AxisVector::Zero(axes)};
    double count = 0;
    for (const Segment& segment : segments) {
        AxisVector sum = AxisVector::Zero(axes);
        for (const Sample& sample : samples.subspan(segment.begin, segment.size())) sum += sample.rate;
        figures.bias_rad_s += sum;
        means.emplace_back(sum / static_cast<double>(segment.size()));
        for (const Sample& sample : samples.subspan(segment.begin, segment.size()))
            figures.deviation_rad_s += (sample.rate - means.back()).cwiseAbs2();
        count += static_cast<double>(segment.size());
    }
    figures.bias_rad_s /= count;
    figures.deviation_rad_s = (figures.deviation_rad_s / (count - static_cast<double>(segments.size()))).cwiseSqrt();
    for (const AxisVector& mean : means) figures.bias_spread_rad_s += (mean - figures.bias_rad_s).cwiseAbs2();
    figures.bias_spread_rad_s = (figures.bias_spread_rad_s / static_cast<double>(std::max<std::size_t>(1, means.size() - 1))).cwiseSqrt();
    return figures;
}

}  // namespace quorient::calibration
