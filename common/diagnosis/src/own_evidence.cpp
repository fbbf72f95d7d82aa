#include "own_evidence.hpp"

#include "rates.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::diagnosis {
namespace {

/// Sound axes repeat a value at rest and at a turning point; not for so long while the others turn by so much.
constexpr double least_stuck_s = 0.3;
constexpr double moved_rad_s = 10 * degree;
constexpr std::size_t most_stuck_spells = 1000;

/// A frame that is so far off is a spike. Shocks do that to sound instruments now and then; so many, and so often, they do not.
constexpr double spike_rad_s = 50 * degree;
constexpr double spike_of_rate = 0.5;
constexpr std::size_t longest_spike = 2;  // frames: a sample may lie across a boundary
constexpr std::size_t least_spikes = 8;
constexpr double longest_between_s = 5;

}  // namespace

void OwnEvidence::add(double begin_s, double end_s, std::span<const Compared> frame)
{
    for (const Compared& one : frame) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            const std::size_t place = 3 * one.instrument + i;
            Axis& axis = axes_[place];
            if (!axis.known || axis.value != one.logged(k)) {
                end(place, false);
                axis = {true, one.logged(k), begin_s, end_s, one.others(k), one.others(k)};
            }
            axis.last_s = end_s;
            axis.least = std::min(axis.least, one.others(k));
            axis.largest = std::max(axis.largest, one.others(k));
        }
    }
    look_for_spikes(end_s, frame);
}

void OwnEvidence::end(std::size_t place, bool log_ends)
{
    const Axis& axis = axes_[place];
    if (!axis.known || axis.last_s - axis.since_s < least_stuck_s || axis.largest - axis.least < moved_rad_s ||
        stuck_.size() >= most_stuck_spells)
        return;
    stuck_.push_back({place / 3, place % 3, axis.value, axis.since_s, log_ends ? std::nullopt : std::optional(axis.last_s)});
}

void OwnEvidence::finish()
{
    for (std::size_t place = 0; place < axes_.size(); ++place) end(place, true);
}

void OwnEvidence::look_for_spikes(double end_s, std::span<const Compared> frame)
{
    double farthest = 0;
    std::optional<std::size_t> off;
    for (const Compared& one : frame) {
        Eigen::Index axis = 0;
        const double difference = (one.measured - one.others).cwiseAbs().maxCoeff(&axis);
        if (difference < std::max({farthest, spike_rad_s, spike_of_rate * one.others.norm()})) continue;
        farthest = difference;
        off = 3 * one.instrument + static_cast<std::size_t>(axis);
    }
    if (run_ && !off) end_run();
    if (!off) return;
    if (!run_) run_ = Run{*off, 0, 0, end_s};
    ++run_->frames;
    if (farthest <= run_->largest) return;
    run_->largest = farthest;
    run_->place = *off;
}

/// What lasts longer is no spike.
void OwnEvidence::end_run()
{
    if (run_->frames <= longest_spike) {
        Spikes& spikes = spikes_[run_->place];
        if (spikes.count == 0) spikes.first_s = run_->begin_s;
        ++spikes.count;
        spikes.sum += run_->largest;
        spikes.last_s = run_->begin_s;
    }
    run_.reset();
}

std::vector<SpikeTrain> OwnEvidence::spikes() const
{
    std::vector<SpikeTrain> trains;
    for (std::size_t place = 0; place < spikes_.size(); ++place) {
        const Spikes& spikes = spikes_[place];
        const auto count = static_cast<double>(spikes.count);
        if (spikes.count < least_spikes || spikes.last_s - spikes.first_s > longest_between_s * count) continue;
        trains.push_back({place / 3, place % 3, spikes.count, spikes.sum / count, spikes.first_s, spikes.last_s});
    }
    return trains;
}

}  // namespace quorient::diagnosis
