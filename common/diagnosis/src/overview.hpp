#pragma once

#include "decimated.hpp"
#include "rates.hpp"

#include "quorient/diagnosis/report.hpp"
#include "quorient/recording/resampler.hpp"

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace quorient::diagnosis {

/// Mean rates over about a tenth of a second: vibration and the uncertainty of times average out, the motion stays.
struct Block {
    double from_s = 0;
    double to_s = 0;
    std::uint32_t present = 0;  ///< bit m: instrument m has data in all frames of the block
    std::array<Eigen::Vector3f, recording::max_triads> rate_rad_s;  ///< along each instrument's axes
};

/// One instrument had no data while another one had.
struct Absence {
    std::size_t instrument = 0;
    double from_s = 0;
    std::optional<double> to_s;  ///< nothing: to the log's end
};

/// What a first look at all frames shows: blocks for fits, and the rests with biases and noise in them.
class Overview {
public:
    explicit Overview(std::size_t instruments) : count_(instruments) {}

    void add(const recording::AlignedFrame& frame);
    void finish();

    std::size_t instruments() const { return count_; }
    const std::vector<Block>& blocks() const { return blocks_.items(); }
    const std::vector<Rest>& rests() const { return rests_; }

    std::optional<Rest> longest_rest() const;

    /// Mean of an instrument in the longest rest [rad/s]. Nothing where there is no rest, or no data in it.
    std::optional<Eigen::Vector3d> rest_bias(std::size_t m) const;

    /// Mean of an instrument in the first rest [rad/s]; 0 where there is none.
    Eigen::Vector3d first_rest_mean(std::size_t m) const;

    /// Standard deviation of one frame about the mean of a second, over all rests [rad/s].
    std::optional<Eigen::Vector3d> rest_noise(std::size_t m) const;

    /// Those of more than a second.
    const std::vector<Absence>& absences() const { return absences_; }

    std::uint64_t frames() const { return frames_; }
    double first_s() const { return first_s_; }
    double last_s() const { return last_s_; }

private:
    struct Sums {
        double frames = 0;
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        Eigen::Vector3d squares = Eigen::Vector3d::Zero();

        Eigen::Vector3d mean() const { return sum / frames; }
        Eigen::Vector3d deviation() const;
        void add(const Eigen::Vector3d& rate);
    };
    using AllSums = std::array<Sums, recording::max_triads>;

    void note_presence(const recording::AlignedFrame& frame, double begin_s);
    void end_block();
    void end_stretch();
    bool stretch_is_rest() const;
    void end_rest();

    std::size_t count_;
    std::uint64_t frames_ = 0;
    double first_s_ = 0;
    double last_s_ = 0;
    std::array<std::optional<double>, recording::max_triads> absent_since_s_{};
    std::vector<Absence> absences_;
    double block_begin_s_ = 0;
    AllSums block_;
    double block_frames_ = 0;
    Decimated<Block> blocks_{20'000};
    double stretch_begin_s_ = 0;
    AllSums stretch_;
    std::optional<Rest> rest_;  ///< under way
    AllSums rest_sums_;
    double longest_rest_s_ = 0;
    AllSums longest_sums_;
    AllSums first_sums_;
    std::vector<Rest> rests_;
    AllSums noise_;  ///< all rests: squares about the means of single seconds
};

}  // namespace quorient::diagnosis
