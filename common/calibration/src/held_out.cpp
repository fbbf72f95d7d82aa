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

/// The samples of some segments as if they were one recording; nothing follows across a joint.
class Joined final : public SampleSource {
public:
    Joined(Samples samples, std::vector<Segment> segments) : samples_(samples), segments_(std::move(segments))
    {
        std::ranges::sort(segments_, {}, &Segment::begin);
        std::size_t end = 0;  // where the segment before ended
        for (const Segment& segment : segments_) {
            begins_.push_back(size_);
            follows_.push_back(segment.begin == end);
            size_ += segment.size();
            end = segment.end;
        }
    }

    std::size_t size() const override { return size_; }

    Sample at(std::size_t index) const override
    {
        const auto after = std::ranges::upper_bound(begins_, index);
        const auto place = static_cast<std::size_t>(after - begins_.begin()) - 1;
        const std::size_t within = index - begins_[place];
        Sample sample = samples_[segments_[place].begin + within];
        if (within == 0) sample.follows = sample.follows && follows_[place];
        return sample;
    }

private:
    Samples samples_;
    std::vector<Segment> segments_;
    std::vector<std::size_t> begins_;  ///< where each segment begins in the joined recording
    std::vector<bool> follows_;        ///< each segment begins where the one before ended
    std::size_t size_ = 0;
};

}  // namespace

void HeldOut::play(Samples samples, const Stretch& stretch, const std::function<void(std::size_t, const fdi::Measurement&)>& take) const
{
    const std::size_t axes = cluster.size();
    std::array<double, max_axes> increment{};
    for (std::size_t i = stretch.lead; i < stretch.end; ++i) {
        const Sample sample = samples[i];
        for (std::size_t axis = 0; axis < axes; ++axis) increment[axis] = calibration.corrected(sample, axis);
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
        const Joined known(samples, std::move(other));
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
