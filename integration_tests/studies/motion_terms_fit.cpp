#include "motion_terms_fit.hpp"

#include "arrays/accumulating_detector.hpp"
#include "quorient/fdi/array_sums.hpp"
#include "quorient/fdi/noise.hpp"
#include "quorient/calibration/term_search.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace quorient::studies {

namespace {

using calibration::Samples;

constexpr double largest_wanted = 0.85;
constexpr std::array<std::size_t, 10> windows{1, 2, 4, 8, 16, 32, 64, 128, 256, 512};
static_assert(windows.back() == fdi::ArraySums::longest_window);

/// Logarithms of the terms that are sought.
using Place = calibration::TermPlace<5>;
using Logs = decltype(Place::logs);

fdi::MotionNoise noise_of(const Logs& logs, const fdi::MotionNoise& start)
{
    fdi::MotionNoise noise = start;
    noise.jitter_along_s = std::exp(logs[0]);
    noise.jitter_across_s = std::exp(logs[1]);
    noise.roughness_s = std::exp(logs[2]);
    noise.axes_error = std::exp(logs[3]);
    noise.rate_error = std::exp(logs[4]);
    return noise;
}

Logs logs_of(const fdi::MotionNoise& noise)
{
    return {std::log(noise.jitter_along_s), std::log(noise.jitter_across_s), std::log(noise.roughness_s), std::log(noise.axes_error),
            std::log(noise.rate_error)};
}

double largest_statistic(Samples samples, const HeldOut& part, const fdi::MotionNoise& noise)
{
    fdi::DetectorSettings settings{.method = "accumulating"};
    settings.instruments = true;
    const auto detector = fdi::AccumulatingDetector::make(settings, part.cluster, noise).value();
    fdi::Assessment assessment;
    double largest = 0;
    for (const auto& stretch : part.stretches) {
        detector->reset();
        part.play(samples, stretch, [&](std::size_t i, const fdi::Measurement& measurement) {
            detector->assess(measurement, assessment);
            if (i >= stretch.begin) largest = std::max(largest, assessment.statistic);
        });
    }
    return largest;
}

/// A mean in the making.
struct Mean {
    double sum = 0;
    double count = 0;
};

/// Logarithm of the smallest detectable step of each axis in this window: inverse to the square root of its information.
void add_window(const fdi::ArraySums& sums, std::size_t length, double interval_s, double threshold, Mean& mean)
{
    const auto fit = sums.fit(length);
    for (std::size_t m = 0; m < sums.array().size(); ++m) {
        const auto& instrument = sums.array()[m];
        const Eigen::Matrix3d q = fit.contradiction(m).q;
        for (std::size_t i = 0; i < instrument.size; ++i) {
            const Eigen::Vector3d direction = fit.weight * instrument.body_from_axes.col(static_cast<Eigen::Index>(i)) * interval_s;
            mean.sum += std::log(threshold / direction.dot(q * direction)) / 2;
            ++mean.count;
        }
    }
}

/// Windows that lie within the motion, end to end.
void add_steps(Samples samples, const HeldOut& part, const fdi::MotionNoise& noise, std::array<Mean, windows.size()>& means)
{
    const auto sigma = fdi::sigma_of_axes({}, part.cluster).value();
    const double threshold = fdi::chi_square_quantile(1, 1e-9);  // near that of every window: a common factor
    fdi::ArraySums sums(fdi::InstrumentArray::make(part.cluster, sigma.cwiseAbs2()).value(), noise);
    for (const auto& stretch : part.stretches) {
        sums.reset();
        part.play(samples, stretch, [&](std::size_t i, const fdi::Measurement& measurement) {
            if (sums.add(measurement) != fdi::ArraySums::Added::counted) return;
            for (std::size_t w = 0; w < windows.size(); ++w) {
                const std::size_t length = windows[w];
                if (i < stretch.begin + length || (i - stretch.begin) % length != 0 || sums.size() <= length) continue;
                add_window(sums, length, part.cluster.interval_s, threshold, means[w]);
            }
        });
    }
}

}  // namespace

Standing standing(Samples samples, const std::vector<HeldOut>& parts, const fdi::MotionNoise& noise)
{
    Standing result;
    std::array<Mean, windows.size()> means;
    for (const HeldOut& part : parts) {
        result.largest_statistic = std::max(result.largest_statistic, largest_statistic(samples, part, noise));
        add_steps(samples, part, noise, means);
    }
    Mean overall;
    for (const Mean& mean : means) {
        if (mean.count == 0) continue;
        overall.sum += mean.sum / mean.count;
        ++overall.count;
    }
    result.smallest_step_rad_s = std::exp(overall.sum / overall.count);
    return result;
}

fdi::MotionNoise tightest_silent(Samples samples, const std::vector<HeldOut>& parts, const fdi::MotionNoise& start)
{
    const auto seen = [&](const Logs& logs) {
        const Standing now = standing(samples, parts, noise_of(logs, start));
        return Place{logs, std::log(now.smallest_step_rad_s), std::log(now.largest_statistic / largest_wanted)};
    };
    return noise_of(calibration::TermSearch<5, decltype(seen)>(seen(logs_of(start)), seen, {}).result(), start);
}

}  // namespace quorient::studies
