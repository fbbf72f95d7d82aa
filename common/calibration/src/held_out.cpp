#include "quorient/calibration/held_out.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace quorient::calibration {

namespace {


constexpr double longest_stretch_s = 20;

/// The segments between these.
std::vector<Segment> between(const std::vector<Segment>& rest, std::size_t samples)
{
    std::vector<Segment> gaps;
    std::size_t begin = 0;
    const auto add = [&](std::size_t end) {
        if (end > begin) gaps.push_back({begin, end});
    };
    for (const Segment& segment : rest) {
        add(segment.begin);
        begin = segment.end;
    }
    add(samples);
    return gaps;
}

std::vector<Segment> stretches_of(const std::vector<Segment>& rest, Samples samples)
{
    std::vector<Segment> stretches;
    for (const Segment& gap : between(rest, samples.size())) {
        const double duration_s = samples[gap.end - 1].time_s - samples[gap.begin].time_s;
        const std::size_t middle = duration_s > longest_stretch_s ? (gap.begin + gap.end) / 2 : gap.end;
        stretches.push_back({gap.begin, middle});
        if (middle < gap.end) stretches.push_back({middle, gap.end});
    }
    return stretches;
}

/// The samples of these segments, in order. A segment that does not adjoin the previous one is marked as not following.
std::vector<Sample> joined(Samples samples, std::vector<Segment> segments)
{
    std::sort(segments.begin(), segments.end(), [](const Segment& one, const Segment& two) { return one.begin < two.begin; });
    std::vector<Sample> result;
    std::size_t end = 0;
    for (const Segment& segment : segments) {
        const std::size_t first = result.size();
        result.insert(result.end(), samples.begin() + static_cast<std::ptrdiff_t>(segment.begin),
                      samples.begin() + static_cast<std::ptrdiff_t>(segment.end));
        if (segment.begin != end) result[first].follows = false;
        end = segment.end;
    }
    return result;
}

}  // namespace

void HeldOut::play(Samples samples, const Stretch& stretch, const std::function<void(std::size_t, const fdi::Measurement&)>& take) const
{
    const std::size_t axes = cluster.size();
    std::array<double, max_axes> increment{};
    for (std::size_t i = stretch.lead; i < stretch.end; ++i) {
        const Sample& sample = samples[i];
        for (std::size_t axis = 0; axis < axes; ++axis) {
            const double rate = sample.rate(static_cast<Eigen::Index>(axis)) - calibration.description.bias[axis];
            increment[axis] = rate * sample.interval_s / calibration.gain[axis];
        }
        take(i, {.identity = {.epoch = 1, .sequence = i},
                 .interval_s = sample.interval_s,
                 .increment = std::span(std::as_const(increment)).first(axes),
                 .valid = sample.complete ? all_axes(axes) : 0});
    }
}

std::vector<HeldOut> held_out_halves(Samples samples, const ClusterDescription& nominal, const std::vector<Segment>& rest,
                                     const RestSettings& settings)
{
    std::array<std::vector<Segment>, 2> moving;
    std::array<std::vector<Segment>, 2> resting;
    const auto stretches = stretches_of(rest, samples);
    for (std::size_t i = 0; i < stretches.size(); ++i) moving[i % 2].push_back(stretches[i]);
    for (std::size_t i = 0; i < rest.size(); ++i) resting[i % 2].push_back(rest[i]);
    std::vector<HeldOut> halves;
    for (std::size_t half = 0; half < 2; ++half) {
        auto other = moving[1 - half];
        other.insert(other.end(), resting[1 - half].begin(), resting[1 - half].end());
        const auto known = joined(samples, other);
        auto calibration = calibrate(known, nominal, settings);
        if (!calibration || !calibration->axes_note.empty() || moving[half].empty()) return {};
        auto cluster = geometry::make_cluster(calibration->cluster.description);
        if (!cluster) return {};
        HeldOut held{.cluster = std::move(*cluster), .calibration = std::move(calibration->cluster), .stretches = {}};
        for (const Segment& segment : moving[half]) {
            const std::size_t lead = segment.begin - std::min(segment.begin, fdi::ArraySums::longest_window);
            held.stretches.push_back({lead, segment.begin, segment.end});
        }
        halves.push_back(std::move(held));
    }
    return halves;
}

}  // namespace quorient::calibration
