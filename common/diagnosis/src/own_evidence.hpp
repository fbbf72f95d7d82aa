#pragma once

#include "quorient/recording/resampler.hpp"

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace quorient::diagnosis {

/// An axis repeated one value while the others say that it turned.
struct StuckSpell {
    std::size_t instrument = 0;
    std::size_t axis = 0;
    double value = 0;  ///< as it stands in the log
    double from_s = 0;
    std::optional<double> to_s;  ///< nothing: to the log's end
};

/// Single frames of an instrument that are far off the others, again and again.
struct SpikeTrain {
    std::size_t instrument = 0;
    std::size_t axis = 0;
    std::size_t count = 0;
    double mean_rad_s = 0;  ///< magnitude
    double from_s = 0;
    double to_s = 0;
};

/// What an instrument's own values prove, so that two instruments are enough.
class OwnEvidence {
public:
    explicit OwnEvidence(std::size_t instruments) : axes_(3 * instruments), spikes_(3 * instruments) {}

    struct Compared {
        std::size_t instrument;
        Eigen::Vector3d logged;    ///< as it stands in the log
        Eigen::Vector3d measured;  ///< along its axes [rad/s]
        Eigen::Vector3d others;    ///< along the same axes, by the others [rad/s]
    };
    /// All instruments with data in one frame.
    void add(double begin_s, double end_s, std::span<const Compared> frame);
    void finish();

    const std::vector<StuckSpell>& stuck() const { return stuck_; }
    std::vector<SpikeTrain> spikes() const;

private:
    struct Axis {
        bool known = false;
        double value = 0;
        double since_s = 0;
        double last_s = 0;
        double least = 0;    ///< what the others measured since then
        double largest = 0;
    };
    struct Spikes {
        std::size_t count = 0;
        double sum = 0;
        double first_s = 0;
        double last_s = 0;
    };

    void end(std::size_t place, bool log_ends);
    void look_for_spikes(double end_s, std::span<const Compared> frame);
    void end_run();

    std::vector<Axis> axes_;
    std::vector<Spikes> spikes_;
    /// Frames in a row in which an axis is far off, and the one that is farthest.
    struct Run {
        std::size_t place = 0;
        std::size_t frames = 0;
        double largest = 0;
        double begin_s = 0;
    };
    std::optional<Run> run_;
    std::vector<StuckSpell> stuck_;
};

}  // namespace quorient::diagnosis
