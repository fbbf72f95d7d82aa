#include "overview.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::diagnosis {
namespace {

constexpr double block_s = 0.1;
constexpr double stretch_s = 1.0;
constexpr double least_absence_s = 1.0;
constexpr std::size_t most_absences = 1000;

/// A second in which most instruments show no more than this is a rest.
constexpr double resting_deviation_rad_s = 0.5 * degree;
constexpr double resting_rate_rad_s = 6 * degree;
constexpr double least_stretch_frames = 5;

}  // namespace

Eigen::Vector3d Overview::Sums::deviation() const
{
    return (squares / frames - mean().cwiseAbs2()).cwiseMax(0).cwiseSqrt();
}

void Overview::Sums::add(const Eigen::Vector3d& rate)
{
    frames += 1;
    sum += rate;
    squares += rate.cwiseAbs2();
}

void Overview::add(const recording::AlignedFrame& frame)
{
    const double end_s = static_cast<double>(frame.time_ns) * 1e-9;
    const double begin_s = end_s - frame.interval_s;
    if (frames_++ == 0) first_s_ = block_begin_s_ = stretch_begin_s_ = begin_s;
    if (frame.after_gap) {
        end_block();
        end_stretch();
        end_rest();
        block_begin_s_ = stretch_begin_s_ = begin_s;
    }
    last_s_ = end_s;
    note_presence(frame, begin_s);
    block_frames_ += 1;
    for (std::size_t m = 0; m < count_; ++m) {
        if (!has_triad(frame, m)) continue;
        block_[m].add(rate_of(frame, m));
        stretch_[m].add(rate_of(frame, m));
    }
    if (end_s - block_begin_s_ >= block_s - 1e-6) end_block();
    if (end_s - stretch_begin_s_ >= stretch_s - 1e-6) end_stretch();
}

void Overview::finish()
{
    end_block();
    end_rest();
    for (std::size_t m = 0; m < count_; ++m)
        if (absent_since_s_[m] && last_s_ - *absent_since_s_[m] > least_absence_s) absences_.push_back({m, *absent_since_s_[m], std::nullopt});
}

void Overview::note_presence(const recording::AlignedFrame& frame, double begin_s)
{
    for (std::size_t m = 0; m < count_; ++m) {
        std::optional<double>& since_s = absent_since_s_[m];
        if (!has_triad(frame, m)) {
            if (!since_s) since_s = begin_s;
            continue;
        }
        if (since_s && begin_s - *since_s > least_absence_s && absences_.size() < most_absences) absences_.push_back({m, *since_s, begin_s});
        since_s.reset();
    }
}

void Overview::end_block()
{
    if (block_frames_ > 0) {
        Block block;
        block.from_s = block_begin_s_;
        block.to_s = last_s_;
        for (std::size_t m = 0; m < count_; ++m) {
            if (block_[m].frames < block_frames_) continue;
            block.present |= 1U << m;
            block.rate_rad_s[m] = block_[m].mean().cast<float>();
        }
        blocks_.add(block);
    }
    block_ = {};
    block_frames_ = 0;
    block_begin_s_ = last_s_;
}

bool Overview::stretch_is_rest() const
{
    std::vector<double> deviations;
    std::vector<double> rates;
    for (std::size_t m = 0; m < count_; ++m) {
        if (stretch_[m].frames < least_stretch_frames) continue;
        deviations.push_back(stretch_[m].deviation().maxCoeff());
        rates.push_back(stretch_[m].mean().cwiseAbs().maxCoeff());
    }
    return !rates.empty() && median(deviations) < resting_deviation_rad_s && median(rates) < resting_rate_rad_s;
}

void Overview::end_stretch()
{
    if (stretch_is_rest()) {
        if (!rest_) rest_ = Rest{stretch_begin_s_, last_s_};
        rest_->to_s = last_s_;
        for (std::size_t m = 0; m < count_; ++m) {
            const Sums& stretch = stretch_[m];
            if (stretch.frames < least_stretch_frames) continue;
            rest_sums_[m].frames += stretch.frames;
            rest_sums_[m].sum += stretch.sum;
            noise_[m].frames += stretch.frames - 1;
            noise_[m].squares += stretch.squares - stretch.sum.cwiseAbs2() / stretch.frames;
        }
    } else {
        end_rest();
    }
    stretch_ = {};
    stretch_begin_s_ = last_s_;
}

void Overview::end_rest()
{
    if (rest_) {
        if (rests_.empty()) first_sums_ = rest_sums_;
        rests_.push_back(*rest_);
        if (const double length_s = rest_->to_s - rest_->from_s; length_s > longest_rest_s_) {
            longest_rest_s_ = length_s;
            longest_sums_ = rest_sums_;
        }
    }
    rest_.reset();
    rest_sums_ = {};
}

std::optional<Rest> Overview::longest_rest() const
{
    const auto shorter = [](const Rest& a, const Rest& b) { return a.to_s - a.from_s < b.to_s - b.from_s; };
    const auto longest = std::max_element(rests_.begin(), rests_.end(), shorter);
    return longest == rests_.end() ? std::nullopt : std::optional(*longest);
}

std::optional<Eigen::Vector3d> Overview::rest_bias(std::size_t m) const
{
    if (longest_sums_[m].frames == 0) return std::nullopt;
    return longest_sums_[m].mean();
}

Eigen::Vector3d Overview::first_rest_mean(std::size_t m) const
{
    return first_sums_[m].frames > 0 ? first_sums_[m].mean() : Eigen::Vector3d::Zero();
}

std::optional<Eigen::Vector3d> Overview::rest_noise(std::size_t m) const
{
    if (noise_[m].frames == 0) return std::nullopt;
    return (noise_[m].squares / noise_[m].frames).cwiseMax(0).cwiseSqrt();
}

}  // namespace quorient::diagnosis
